#include "io/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/io_support.h"

namespace rangepose {
namespace {

namespace fs = std::filesystem;
using test::bytesOf;
using test::errorOf;
using test::TempFolder;
using testing::HasSubstr;

std::size_t entryCount(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(AtomicFile, WritesAndReplacesAndLeavesNothingElse) {
  const TempFolder folder;
  const fs::path path = folder.path() / "out.bin";
  writeFileAtomically(path, std::string_view("a\0b", 3));
  EXPECT_EQ(bytesOf(path), std::string("a\0b", 3));
  writeFileAtomically(path, "new");
  EXPECT_EQ(bytesOf(path), "new");
  EXPECT_EQ(entryCount(folder.path()), 1u);
}

TEST(AtomicFile, MissingFolderIsAnErrorThatNamesTheFile) {
  const TempFolder folder;
  const std::string error =
      errorOf([&] { writeFileAtomically(folder.path() / "no" / "out.bin", "x"); });
  EXPECT_THAT(error, HasSubstr("out.bin"));
  EXPECT_THAT(error, HasSubstr("No such file or directory"));
}

TEST(AtomicFile, FolderAsTargetIsAnErrorAndStays) {
  const TempFolder folder;
  fs::create_directory(folder.path() / "out");
  EXPECT_THAT(errorOf([&] { writeFileAtomically(folder.path() / "out", "x"); }),
              HasSubstr("it is a folder"));
  EXPECT_TRUE(fs::is_directory(folder.path() / "out"));
  EXPECT_EQ(entryCount(folder.path()), 1u);
}

TEST(AtomicFile, FollowsASymbolicLink) {
  const TempFolder folder;
  const fs::path target = folder.write("deep/target.txt", "old");
  fs::create_symlink(target, folder.path() / "link.txt");
  writeFileAtomically(folder.path() / "link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link.txt"));
  EXPECT_EQ(bytesOf(target), "new");
}

TEST(AtomicFile, DeviceIsWrittenAndNotReplaced) {
  writeFileAtomically("/dev/null", "x");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THAT(errorOf([] { writeFileAtomically("/dev/full", std::string(1 << 16, 'x')); }),
              HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace rangepose
