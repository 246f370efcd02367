// The results of a run over a BOP data set so far, kept in a file beside the CSV, so that a run
// that was interrupted can be gone on with.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace rangepose::cli {

/// Name and value of each setting that a result depends on; values are one line.
using RunFacts = std::vector<std::pair<std::string, std::string>>;

struct DoneImage {
  double time_s = 0.0;  ///< as in the rows
  int poses = 0;
  std::string rows;  ///< of the CSV, each with its line end
};

/// Scene id, image id.
using ImageKey = std::pair<int, int>;

class BopJournal {
 public:
  /// Makes `csv`.partial, or with `resume` goes on with the one that is there. Throws Error where
  /// there is one but `resume` is not set, it is from a run with other facts, or it is damaged; an
  /// image that was being written when the run ended is left out. Where `csv` is no file but a
  /// device nothing is kept.
  BopJournal(const std::filesystem::path& csv, const RunFacts& facts, bool resume);

  const std::map<ImageKey, DoneImage>& done() const { return done_; }
  /// Writes it at once.
  void add(const ImageKey& key, DoneImage image);
  /// Writes the CSV, scene by scene and image by image, and removes the side file.
  void finish();

 private:
  void read(const RunFacts& facts);
  void append(const std::string& block);

  std::filesystem::path csv_;
  std::filesystem::path side_file_;  ///< empty: nothing is kept
  std::map<ImageKey, DoneImage> done_;
};

}  // namespace rangepose::cli
