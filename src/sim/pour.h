// Parts let go over a bin, a layer at a time. Private to the drop.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/bullet_bin.h"
#include "sim/drop.h"
#include "sim/random.h"

namespace rangepose {

class Pourer {
 public:
  /// All three must outlive it.
  Pourer(const std::vector<PhysicsPart>& parts, const BinShape& bin, Random& random)
      : parts_(parts), bin_(bin), random_(random) {}

  /// Indices of parts, counts[k] times k, in random order.
  std::vector<int> order(const std::vector<int>& counts);
  /// Lets as many of order[next...] go as find room beside each other, above all that is there;
  /// returns the index of the first that did not. Throws Error for a part wider than the bin.
  std::size_t pour(const std::vector<int>& order, std::size_t next, BulletBin& world);

 private:
  struct Start {
    glm::dmat3 rotation{1.0};
    glm::dvec2 at{0.0};  ///< of the centre of mass [mm]
  };

  Start randomStart(const PhysicsPart& part);
  void release(int index, const Start& start, double height_mm, BulletBin& world);

  const std::vector<PhysicsPart>& parts_;
  const BinShape& bin_;
  Random& random_;
};

}  // namespace rangepose
