// rangepose_ppf: OpenCV's surface_matching on a BOP data set, for comparison with rangepose.
#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <string>
#include <thread>

#include "core/error.h"
#include "core/parallel.h"
#include "io/bop.h"
#include "io/depth_file.h"
#include "peers/ppf_estimate.h"
#include "rangepose/console.h"
#include "rangepose/progress.h"

namespace rangepose::peers {
namespace {

struct Arguments {
  std::string database;
  std::string folder;
  std::string split = "test";
  std::string csv;
  int threads = 0;
  PpfEstimateOptions options;
};

void declareOptions(CLI::App& app, Arguments& arguments) {
  PpfEstimateOptions& options = arguments.options;
  app.add_option("--db", arguments.database, "Reference database of the parts, see rangepose build")
      ->required();
  app.add_option("--bop", arguments.folder, "BOP data set, as rangepose simulate writes it")
      ->required();
  app.add_option("--csv", arguments.csv, "Result file")->required();
  app.add_option("--split", arguments.split, "Of the data set")->capture_default_str();
  app.add_option("--threads", arguments.threads, "0: all cores; no effect on results")
      ->check(CLI::Range(0, 1024));
  const auto share = [&app](const std::string& name, double& value, const std::string& what) {
    app.add_option(name, value, what)->check(CLI::Range(0.005, 2.0))->capture_default_str();
  };
  share("--spacing", options.ppf.spacing, "Of the points of model and scene [diameters]");
  share("--distance-step", options.ppf.distance_step, "Of distances of pairs [diagonals]");
  share("--crop", options.crop_radius, "Radius around a seed [diameters]");
  share("--seeds-apart", options.seeds_apart, "Distance of seeds [diameters]");
  const auto number = [&app](const std::string& name, int& value, const std::string& what) {
    app.add_option(name, value, what)->check(CLI::Range(1, 10000))->capture_default_str();
  };
  number("--points", options.ppf.most_points, "Of the model at most; else the spacing grows");
  number("--angles", options.ppf.angles, "Steps of a full turn");
  number("--seeds", options.most_seeds, "Seeds of an object at most");
  number("--glanced", options.glanced, "Poses of a crop with the most votes that are looked at");
  number("--aligned", options.aligned, "Best of these that are aligned by ICP");
  number("--finalists", options.finalists, "Best of these that are aligned again");
  app.add_option("--references", options.ppf.reference_share, "Share of the points that vote")
      ->check(CLI::Range(0.01, 1.0))
      ->capture_default_str();
  app.add_option("--min-score", options.min_score, "Poses below are not reported")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
}

void run(Arguments& arguments) {
  cli::checkOutputFile(arguments.csv);
  const BopDataset data = openBop(arguments.folder, arguments.split);
  const int total = imageCount(data);
  if (total == 0) {
    throw Error("BOP data set " + arguments.folder + ": has no images in split " + arguments.split +
                "; name another one by --split");
  }
  const ReferenceDatabase database = readDatabase(arguments.database);
  setThreadCount(arguments.threads);
  cv::setNumThreads(1);  // crops are what runs at the same time
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  arguments.options.workers = arguments.threads > 0 ? arguments.threads : static_cast<int>(cores);
  PpfEstimator estimator(database, arguments.options);
  std::vector<BopEstimate> rows;
  double time_s = 0.0;
  int done = 0;
  cli::Progress progress(std::cerr, "images", total, cli::terminalProgress());
  for (const BopScene& scene : data.scenes) {
    for (const BopImage& image : scene.images) {
      const DepthImage depth = readDepth(image.depth_path, image.camera);
      const auto begin = std::chrono::steady_clock::now();
      const std::vector<Candidate> poses = estimator.estimate(depth, image.bin);
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
      time_s += time.count();
      for (const Candidate& pose : poses) {
        const int obj_id = database.objects.at(static_cast<std::size_t>(pose.object)).id;
        rows.push_back(
            {scene.scene_id, image.im_id, obj_id, pose.confidence, pose.pose, time.count()});
      }
      progress.update(++done);
    }
  }
  writeBopCsv(arguments.csv, rows);
  progress.clear();
  std::cout << "OpenCV PPF: " << total << " images, " << rows.size() << " poses, "
            << time_s / static_cast<double>(total) << " s an image on average\n";
}

}  // namespace
}  // namespace rangepose::peers

int main(int argc, char** argv) {
  try {
    CLI::App app("Finds parts in the images of a BOP data set by OpenCV's surface_matching.");
    rangepose::peers::Arguments arguments;
    rangepose::peers::declareOptions(app, arguments);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return app.exit(error) == 0 ? 0 : 2;
    }
    rangepose::peers::run(arguments);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "rangepose_ppf: " << error.what() << '\n';
    return 1;
  }
}
