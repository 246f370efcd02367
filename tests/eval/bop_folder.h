// A small data set in the BOP layout, made on the spot: two objects, three images, and its truth.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "core/camera.h"
#include "eval/eval_support.h"
#include "io/bop.h"
#include "io/io_support.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose::test {

inline std::string plyText(const Mesh& mesh) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(),
      mesh.triangles.size());
  for (const glm::vec3& v : mesh.vertices) text += fmt::format("{} {} {}\n", v.x, v.y, v.z);
  for (const glm::uvec3& t : mesh.triangles) text += fmt::format("3 {} {} {}\n", t.x, t.y, t.z);
  return text;
}

inline std::string poseJson(int obj_id, const Pose& pose) {
  std::string rotation;
  for (int i = 0; i < 9; ++i) {
    rotation += fmt::format("{}{}", i > 0 ? "," : "", pose.rotation[i % 3][i / 3]);
  }
  const glm::dvec3& t = pose.translation_mm;
  return fmt::format(R"({{"obj_id":{},"cam_R_m2c":[{}],"cam_t_m2c":[{},{},{}]}})",
                     obj_id,
                     rotation,
                     t.x,
                     t.y,
                     t.z);
}

/// Object 1 is the bracket of box_mesh.h, without symmetry; object 2 the cone of eval_support.h,
/// whose symmetry stands in models_info.json. Each of the images 0, 1, 2 of scene 4 shows two of
/// object 1 and one of object 2, side by side.
class BopFolderOfParts : public TempFolder {
 public:
  static constexpr int kImages = 3;
  static constexpr int kParts = 3;

  BopFolderOfParts() {
    write("models/obj_000001.ply", plyText(bracket_));
    write("models/obj_000002.ply", plyText(coneMesh()));
    write("models/models_info.json",
          R"({"1":{"diameter":54},"2":{"diameter":58,
              "symmetries_continuous":[{"axis":[0,0,1],"offset":[12,-5,0]}]}})");
    std::string cameras;
    std::string truths;
    std::string infos;
    for (int im_id = 0; im_id < kImages; ++im_id) {
      const char* comma = im_id > 0 ? "," : "";
      cameras += fmt::format(
          R"({}"{}":{{"cam_K":[400,0,159.5,0,400,119.5,0,0,1],"depth_scale":0.1}})", comma, im_id);
      truths += fmt::format(R"({}"{}":[{},{},{}])",
                            comma,
                            im_id,
                            poseJson(1, truth(im_id, 0)),
                            poseJson(1, truth(im_id, 1)),
                            poseJson(2, truth(im_id, 2)));
      infos += fmt::format(
          R"({}"{}":[{{"visib_fract":1.0}},{{"visib_fract":0.3}},{{"visib_fract":0.8}}])",
          comma,
          im_id);
      writeDepth(im_id);
    }
    write("test/000004/scene_camera.json", "{" + cameras + "}");
    write("test/000004/scene_gt.json", "{" + truths + "}");
    write("test/000004/scene_gt_info.json", "{" + infos + "}");
  }

  static int objectOf(int part) { return part == 2 ? 2 : 1; }

  static Pose truth(int im_id, int part) {
    return {rotationFromVector({0.4 + im_id, 0.3 * part, 0.2}),
            {-90.0 + 90.0 * part, 10.0 * im_id, 500.0}};
  }

  /// What a perfect method would answer.
  static std::vector<BopEstimate> perfect() {
    std::vector<BopEstimate> rows;
    for (int im_id = 0; im_id < kImages; ++im_id) {
      for (int part = 0; part < kParts; ++part) {
        rows.push_back({4, im_id, objectOf(part), 0.9 - 0.1 * part, truth(im_id, part), 0.25});
      }
    }
    return rows;
  }

 private:
  void writeDepth(int im_id) const {
    DepthImage image;
    image.camera = pinholeCamera(320, 240, 400.0);
    for (int part = 0; part < kParts; ++part) {
      measure(image, objectOf(part) == 1 ? bracket_ : coneMesh(), truth(im_id, part));
    }
    cv::Mat values(240, 320, CV_16UC1);
    for (int v = 0; v < values.rows; ++v) {
      for (int u = 0; u < values.cols; ++u) {
        values.at<std::uint16_t>(v, u) =
            static_cast<std::uint16_t>(std::lround(10.0f * image.depth_mm.at(u, v)));
      }
    }
    const auto file = write(fmt::format("test/000004/depth/{:06}.png", im_id), "");
    cv::imwrite(file.string(), values);
  }

  const Mesh bracket_ = meshOf(bracketBoxes());
};

}  // namespace rangepose::test
