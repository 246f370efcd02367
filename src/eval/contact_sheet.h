// One bin being emptied, step by step, as the paper's Fig. 15 shows it: what lies in the bin with
// the detected part marked, and the scan.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "eval/emptying.h"

namespace rangepose {

class ContactSheet {
 public:
  /// `mesh` must outlive the sheet; `columns` steps lie side by side.
  ContactSheet(const Mesh& mesh, std::string title, int columns = 5);

  /// Adds a step. The final pose is marked green where it is right, red where it is wrong.
  void add(const Trial& trial, const BinScan& scan, const TrialAnswer& answer);

  bool empty() const { return tiles_.empty(); }
  cv::Mat picture() const;

 private:
  const Mesh* mesh_;
  std::string title_;
  int columns_;
  std::vector<cv::Mat> tiles_;
};

}  // namespace rangepose
