// Stages of several paths side by side, and where they differ.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/image.h"

namespace rangepose::debug {

/// What a stage made on each path; images[0] is that of the reference.
struct ComparedStage {
  enum class Kind {
    kPositive,  ///< 0 is missing, viridis
    kSigned,    ///< about 0, blue to red
    kLabels,    ///< whole numbers; a colour each, negative ones are missing
  };
  std::string name;
  std::string unit;
  Kind kind = Kind::kPositive;
  std::vector<Image<float>> images;
};

/// Pixels that are not equal; a size that differs counts all. `largest` is the largest difference.
struct Difference {
  std::size_t pixels = 0;
  std::size_t all = 0;
  double largest = 0.0;
};
Difference differenceOf(const Image<float>& reference, const Image<float>& subject);

/// A row a stage: the reference, then for each other path its image and the difference (subject
/// minus reference; of labels 1 where they are not the same). Colours mean the same along a row.
cv::Mat comparisonPicture(const std::vector<std::string>& paths,
                          const std::vector<ComparedStage>& stages);

}  // namespace rangepose::debug
