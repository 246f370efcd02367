// What the paper reports of its synthetic data (Tables 1 to 5), for standing beside ours.
#pragma once

#include <optional>
#include <string>

#include "core/glm.h"

namespace rangepose {

/// One of the settings of the paper's tables; N_init is 3 in all of them.
struct PaperSetting {
  std::string sampling = "adaptive";  ///< or "uniform"
  int size = 64;                      ///< width of a reference [px]: 32 or 64
  int views = 1024;                   ///< N_ref: 1024 or 2048
  bool operator==(const PaperSetting&) const = default;
};

/// Errors over the correct poses.
struct PaperErrors {
  double vertex_percent = 0.0;  ///< of the bounding box's diagonal
  glm::dvec3 euler_deg{0.0};
};

struct PaperRough {
  int correct = 0;
  PaperErrors errors;
};

// `model` is "t_pipe", "bolt" or "elbow", or "all". Empty where the paper does not say.
std::optional<PaperRough> paperRough(const PaperSetting& setting, const std::string& model);
std::optional<PaperErrors> paperFine(const PaperSetting& setting, const std::string& model);
std::optional<double> paperMemoryMb(const PaperSetting& setting, const std::string& model);
/// Seconds on a GTX 280.
std::optional<double> paperRoughSeconds(const PaperSetting& setting, const std::string& model);
std::optional<double> paperFineSeconds(const PaperSetting& setting, const std::string& model);

}  // namespace rangepose
