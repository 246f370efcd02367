// A bin with parts in Bullet's world. Private to the drop: the only header that shows Bullet.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "sim/drop.h"

namespace rangepose {

/// The highest point of all parts over the floor [mm].
double topOf(const std::vector<PhysicsPart>& parts, const std::vector<PlacedPart>& placed);

/// Share of its speed that a part loses in a second of the simulation's time.
struct Damping {
  double linear = 0.0;
  double angular = 0.0;
};

/// Lengths are in units of the largest diameter of those that are counted, and time runs such that
/// gravity is 10 units/s^2: Bullet's tolerances are absolute and made for things about one unit
/// wide.
class BulletBin {
 public:
  /// `parts` must outlive it. Floor and walls are half spaces: nothing passes them at any speed.
  /// The walls go on above the rim, so that what falls cannot miss the bin.
  BulletBin(const std::vector<PhysicsPart>& parts,
            const std::vector<int>& counts,
            const BinShape& bin,
            double friction);
  BulletBin(const BulletBin&) = delete;
  BulletBin& operator=(const BulletBin&) = delete;
  ~BulletBin() = default;

  /// `speed_mm_s` downwards, `spin_rad_s` about the bin's axes.
  void add(int part, const Pose& bin_from_object, double speed_mm_s, const glm::dvec3& spin_rad_s);
  void setDamping(const Damping& damping);
  /// Coefficient of friction between parts, and between parts and bin.
  void setFriction(double friction);
  void run(double seconds);

  std::vector<PlacedPart> placed() const;
  /// How far parts reach into one another or into the bin [mm]; what pieces stand out over the
  /// surface counts, too, so it is never less than the truth.
  double depthMm() const;

 private:
  struct Shape {
    std::vector<std::unique_ptr<btConvexHullShape>> pieces;
    std::unique_ptr<btCompoundShape> compound;
    btVector3 inertia;  ///< of mass 1
  };

  void addShape(const PhysicsPart& part);
  void addPlane(const btVector3& normal, double offset_mm);

  const std::vector<PhysicsPart>& parts_;
  double unit_mm_;
  double time_scale_;  ///< seconds of the simulation in a second
  btScalar friction_;  ///< of a body: Bullet multiplies those of two that touch
  std::vector<Shape> shapes_;
  std::vector<std::unique_ptr<btStaticPlaneShape>> planes_;
  std::vector<std::unique_ptr<btRigidBody>> fixed_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<int> kinds_;  ///< by body: index of its part
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
};

}  // namespace rangepose
