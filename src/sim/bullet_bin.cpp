#include "sim/bullet_bin.h"

#include <algorithm>
#include <cmath>

namespace rangepose {
namespace {

constexpr double kGravity = 10.0;        // [units/s^2]
constexpr double kGravityMm = 9810.0;    // [mm/s^2]
constexpr double kStep = 1.0 / 120.0;    // [s of the simulation]
constexpr double kLeastMargin = 0.0015;  // [units]
constexpr int kSolverIterations = 12;

btVector3 toBullet(const glm::dvec3& v) {
  return {static_cast<btScalar>(v.x), static_cast<btScalar>(v.y), static_cast<btScalar>(v.z)};
}

glm::dvec3 toGlm(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

btTransform toBullet(const Pose& pose, double unit_mm) {
  const glm::dmat3& r = pose.rotation;
  const auto s = [&r](int row, int column) { return static_cast<btScalar>(r[column][row]); };
  return btTransform(
      btMatrix3x3(s(0, 0), s(0, 1), s(0, 2), s(1, 0), s(1, 1), s(1, 2), s(2, 0), s(2, 1), s(2, 2)),
      toBullet(pose.translation_mm / unit_mm));
}

Pose toPose(const btTransform& transform, double unit_mm) {
  Pose pose;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      pose.rotation[j][i] = static_cast<double>(transform.getBasis()[i][j]);
    }
  }
  pose.rotation = orthonormalized(pose.rotation);
  pose.translation_mm = unit_mm * toGlm(transform.getOrigin());
  return pose;
}

double largestDiameter(const std::vector<PhysicsPart>& parts, const std::vector<int>& counts) {
  double largest = 0.0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (counts[k] > 0) largest = std::max(largest, parts[k].diameter_mm);
  }
  return largest;
}

}  // namespace

BulletBin::BulletBin(const std::vector<PhysicsPart>& parts,
                     const std::vector<int>& counts,
                     const BinShape& bin,
                     double friction)
    : parts_(parts),
      unit_mm_(largestDiameter(parts, counts)),
      time_scale_(std::sqrt(kGravityMm / unit_mm_ / kGravity)),
      friction_(static_cast<btScalar>(std::sqrt(friction))),
      dispatcher_(&configuration_),
      world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
  // More than one contact a step where a piece lies flat on the floor.
  configuration_.setPlaneConvexMultipointIterations(3, 3);
  world_.setGravity(btVector3(0, 0, static_cast<btScalar>(-kGravity)));
  world_.getDispatchInfo().m_deterministicOverlappingPairs = true;
  btContactSolverInfo& info = world_.getSolverInfo();
  info.m_numIterations = kSolverIterations;
  // Depth is taken away by moving, not by speed, at any depth, and softly: no bouncing.
  info.m_splitImpulse = 1;
  info.m_splitImpulsePenetrationThreshold = -1e-4f;
  info.m_erp2 = 0.1f;
  // Without all of these a heap creeps for many seconds.
  info.m_warmstartingFactor = 1.0f;
  info.m_frictionERP = 0.5f;
  info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  for (const PhysicsPart& part : parts) addShape(part);
  const glm::dvec3 half = 0.5 * bin.inner_mm;
  addPlane(btVector3(0, 0, 1), 0.0);
  addPlane(btVector3(1, 0, 0), -half.x);
  addPlane(btVector3(-1, 0, 0), -half.x);
  addPlane(btVector3(0, 1, 0), -half.y);
  addPlane(btVector3(0, -1, 0), -half.y);
}

void BulletBin::addShape(const PhysicsPart& part) {
  Shape shape;
  shape.compound = std::make_unique<btCompoundShape>(true, static_cast<int>(part.pieces.size()));
  const Pose body_from_object = part.mass.object_from_body.inverse();
  for (const ConvexPiece& piece : part.pieces) {
    auto hull = std::make_unique<btConvexHullShape>();
    for (const glm::dvec3& corner : piece.corners_mm) {
      hull->addPoint(toBullet(body_from_object * corner / unit_mm_), false);
    }
    // Bullet adds the margin to the hull: it makes up for what simplifying has cut off.
    hull->setMargin(static_cast<btScalar>(std::max(kLeastMargin, piece.short_mm / unit_mm_)));
    hull->recalcLocalAabb();
    shape.compound->addChildShape(btTransform::getIdentity(), hull.get());
    shape.pieces.push_back(std::move(hull));
  }
  shape.inertia = toBullet(part.mass.inertia / (unit_mm_ * unit_mm_));
  shapes_.push_back(std::move(shape));
}

void BulletBin::addPlane(const btVector3& normal, double offset_mm) {
  planes_.push_back(
      std::make_unique<btStaticPlaneShape>(normal, static_cast<btScalar>(offset_mm / unit_mm_)));
  planes_.back()->setMargin(0);
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, planes_.back().get());
  info.m_friction = friction_;
  fixed_.push_back(std::make_unique<btRigidBody>(info));
  world_.addRigidBody(fixed_.back().get());
}

void BulletBin::add(int part,
                    const Pose& bin_from_object,
                    double speed_mm_s,
                    const glm::dvec3& spin_rad_s) {
  const Shape& shape = shapes_.at(static_cast<std::size_t>(part));
  const PhysicsPart& facts = parts_[static_cast<std::size_t>(part)];
  btRigidBody::btRigidBodyConstructionInfo info(1, nullptr, shape.compound.get(), shape.inertia);
  info.m_startWorldTransform = toBullet(bin_from_object * facts.mass.object_from_body, unit_mm_);
  info.m_friction = friction_;
  auto body = std::make_unique<btRigidBody>(info);
  body->setActivationState(DISABLE_DEACTIVATION);
  // A contact that holds remembers where it began to, instead of slipping a little in each step.
  body->setCollisionFlags(body->getCollisionFlags() | btCollisionObject::CF_HAS_FRICTION_ANCHOR);
  body->setLinearVelocity(toBullet(glm::dvec3(0.0, 0.0, -speed_mm_s / unit_mm_ / time_scale_)));
  body->setAngularVelocity(toBullet(spin_rad_s / time_scale_));
  world_.addRigidBody(body.get());
  bodies_.push_back(std::move(body));
  kinds_.push_back(part);
}

void BulletBin::setDamping(const Damping& damping) {
  for (const auto& body : bodies_) {
    body->setDamping(static_cast<btScalar>(damping.linear), static_cast<btScalar>(damping.angular));
  }
}

void BulletBin::setFriction(double friction) {
  friction_ = static_cast<btScalar>(std::sqrt(friction));
  for (const auto& body : fixed_) body->setFriction(friction_);
  for (const auto& body : bodies_) body->setFriction(friction_);
}

void BulletBin::run(double seconds) {
  const auto steps = static_cast<int>(std::ceil(seconds * time_scale_ / kStep));
  for (int k = 0; k < steps; ++k) world_.stepSimulation(static_cast<btScalar>(kStep), 0);
}

std::vector<PlacedPart> BulletBin::placed() const {
  std::vector<PlacedPart> result;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const Pose& object_from_body =
        parts_[static_cast<std::size_t>(kinds_[k])].mass.object_from_body;
    const Pose bin_from_body = toPose(bodies_[k]->getWorldTransform(), unit_mm_);
    result.push_back({kinds_[k], bin_from_body * object_from_body.inverse()});
  }
  return result;
}

double BulletBin::depthMm() const {
  btScalar deepest = 0;
  for (int k = 0; k < dispatcher_.getNumManifolds(); ++k) {
    const btPersistentManifold* manifold =
        const_cast<btCollisionDispatcher&>(dispatcher_).getManifoldByIndexInternal(k);
    for (int i = 0; i < manifold->getNumContacts(); ++i) {
      deepest = std::max(deepest, -manifold->getContactPoint(i).getDistance());
    }
  }
  return unit_mm_ * static_cast<double>(deepest);
}

double topOf(const std::vector<PhysicsPart>& parts, const std::vector<PlacedPart>& placed) {
  double top = 0.0;
  for (const PlacedPart& part : placed) {
    for (const glm::dvec3& corner : parts[static_cast<std::size_t>(part.mesh)].hull_mm) {
      top = std::max(top, (part.world_from_object * corner).z);
    }
  }
  return top;
}

}  // namespace rangepose
