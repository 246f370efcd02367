#include "eval/pose_trial.h"

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "sim/scanner.h"

namespace rangepose {
namespace {

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1.0p-53);
}

/// Shoemake 1992.
glm::dmat3 randomRotation(std::mt19937_64& random) {
  const double u = uniform(random, 0.0, 1.0);
  const double a = uniform(random, 0.0, 2.0 * std::numbers::pi);
  const double b = uniform(random, 0.0, 2.0 * std::numbers::pi);
  return rotationFromQuaternion(std::sqrt(1.0 - u) * std::sin(a),
                                std::sqrt(1.0 - u) * std::cos(a),
                                std::sqrt(u) * std::sin(b),
                                std::sqrt(u) * std::cos(b));
}

/// A ball: what hides a part here must not look like one, flat or round as they are.
Mesh ball(double radius_mm) {
  constexpr int kRings = 24;
  constexpr int kSectors = 48;
  Mesh mesh;
  mesh.name = "ball";
  for (int ring = 0; ring <= kRings; ++ring) {
    const double polar = std::numbers::pi * ring / kRings;
    for (int sector = 0; sector < kSectors; ++sector) {
      const double turn = 2.0 * std::numbers::pi * sector / kSectors;
      mesh.vertices.emplace_back(radius_mm * std::sin(polar) * std::cos(turn),
                                 radius_mm * std::sin(polar) * std::sin(turn),
                                 radius_mm * std::cos(polar));
    }
  }
  const auto vertex = [](int ring, int sector) {
    return static_cast<unsigned>(ring * kSectors + sector % kSectors);
  };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      mesh.triangles.emplace_back(
          vertex(ring, sector), vertex(ring + 1, sector), vertex(ring + 1, sector + 1));
      mesh.triangles.emplace_back(
          vertex(ring, sector), vertex(ring + 1, sector + 1), vertex(ring, sector + 1));
    }
  }
  return cleaned(mesh);
}

/// Pixels at which the scan measured the first part.
int measuredPixels(const std::vector<Mesh>& meshes,
                   const std::vector<PlacedPart>& parts,
                   const Pose& camera_from_world,
                   const ScannerOptions& options) {
  const Scan scan = scanFrom(meshes, parts, camera_from_world, options);
  const CleanView view = renderHeap(meshes, parts, scannerCamera(options), camera_from_world);
  int count = 0;
  for (std::size_t i = 0; i < view.part.size(); ++i) {
    count += view.part.data()[i] == 0 && scan.image.depth_mm.data()[i] > 0.0f ? 1 : 0;
  }
  return count;
}

}  // namespace

PoseTrial makePoseTrial(const Mesh& mesh,
                        std::uint64_t seed,
                        const std::string& sensor,
                        double hidden) {
  PoseTrial trial;
  std::mt19937_64 random(seed);
  const Sphere sphere = boundingSphere(mesh);
  PlacedPart part;
  part.mesh = 0;
  part.world_from_object.rotation = randomRotation(random);
  const glm::dvec3 center(
      uniform(random, -40.0, 40.0), uniform(random, -30.0, 30.0), 1.3 * sphere.radius_mm);
  part.world_from_object.translation_mm =
      center - part.world_from_object.rotation * sphere.center_mm;
  ScannerOptions options;
  options.sensor = sensorModel(sensor);
  options.seed = seed;
  // Looks at the middle of the table, not at the part.
  PlacedPart aim;
  aim.world_from_object.translation_mm = glm::dvec3(0.0, 0.0, center.z);
  const Pose camera_from_world = scannerPose({aim}, options);
  const double ball_mm = 0.9 * sphere.radius_mm;
  const std::vector<Mesh> meshes = {mesh, ball(ball_mm)};
  std::vector<PlacedPart> parts = {part};
  if (hidden > 0.0) {
    // Pushed from far out towards the line of sight until it hides enough.
    const double side = uniform(random, 0.0, 2.0 * std::numbers::pi);
    const double height = center.z + sphere.radius_mm + ball_mm + uniform(random, 0.0, 20.0);
    const glm::dvec3 eye = camera_from_world.inverse().translation_mm;
    const glm::dvec3 on_sight =
        center + (eye - center) * ((height - center.z) / (eye.z - center.z));
    const double unhidden = measuredPixels(meshes, parts, camera_from_world, options);
    double near = 0.0;
    double far = 3.0 * sphere.radius_mm;
    for (int step = 0; step < 7; ++step) {
      const double distance = 0.5 * (near + far);
      PlacedPart occluder;
      occluder.mesh = 1;
      occluder.world_from_object.translation_mm =
          on_sight + distance * glm::dvec3(std::cos(side), std::sin(side), 0.0);
      parts.resize(1);
      parts.push_back(occluder);
      trial.hidden = 1.0 - measuredPixels(meshes, parts, camera_from_world, options) / unhidden;
      (trial.hidden < hidden ? far : near) = distance;
    }
  }
  const Scan scan = scanFrom(meshes, parts, camera_from_world, options);
  trial.image = scan.image;
  trial.camera_from_object = scan.truth[0].camera_from_object;
  return trial;
}

}  // namespace rangepose
