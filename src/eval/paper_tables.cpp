#include "eval/paper_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <set>

namespace rangepose {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

std::string plain(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string angles(const glm::dvec3& degrees) {
  return std::isnan(degrees.x)
             ? "-"
             : fmt::format("{:.2f} {:.2f} {:.2f}", degrees.x, degrees.y, degrees.z);
}

std::string orDash(const std::optional<double>& value, int decimals) {
  return value ? plain(*value, decimals) : "-";
}

/// "203 (96.7 %)".
std::string rightOf(int right, int trials) {
  return fmt::format("{} ({:.1f} %)", right, trials == 0 ? 0.0 : 100.0 * right / trials);
}

/// The models of a run, then "all" where there are several.
struct NamedTrials {
  std::string model;
  std::vector<Trial> trials;
};

std::vector<NamedTrials> rowsOf(const SettingRun& run) {
  std::vector<NamedTrials> rows;
  for (const ModelRun& model : run.models) rows.push_back({model.model, model.trials});
  if (rows.size() > 1) rows.push_back({"all", allTrials(run)});
  return rows;
}

std::string cellsOf(const GradeSummary& summary) {
  return fmt::format("{} | {} | {}",
                     rightOf(summary.right, summary.trials),
                     plain(summary.vertex_percent, 2),
                     angles(summary.euler_deg));
}

std::string roughTable(const std::vector<SettingRun>& runs) {
  std::string text =
      "| model (trials) | sampling | size | views | paper: right | vertex [%] | Euler [deg] | "
      "Eq. 1 alone, no limit: right | vertex [%] | Euler [deg] | Eq. 1 alone: right | vertex [%] | "
      "Euler [deg] | aligned with its view: right | vertex [%] | Euler [deg] |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const SettingRun& run : runs) {
    for (const NamedTrials& row : rowsOf(run)) {
      const std::optional<PaperRough> paper = paperRough(run.setting, row.model);
      fmt::format_to(std::back_inserter(text),
                     "| {} ({}) | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
                     row.model,
                     row.trials.size(),
                     run.setting.sampling,
                     run.setting.size,
                     run.setting.views,
                     paper ? std::to_string(paper->correct) : "-",
                     paper ? plain(paper->errors.vertex_percent, 2) : "-",
                     paper ? angles(paper->errors.euler_deg) : "-",
                     cellsOf(summarize(row.trials, &Trial::unlimited)),
                     cellsOf(summarize(row.trials, &Trial::search)),
                     cellsOf(summarize(row.trials, &Trial::rough)));
    }
  }
  return text;
}

std::string fineTable(const std::vector<SettingRun>& runs) {
  std::string text =
      "| model (trials) | sampling | size | views | paper: vertex [%] | Euler [deg] | right | "
      "vertex [%] | Euler [deg] | rotation [deg] |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const SettingRun& run : runs) {
    for (const NamedTrials& row : rowsOf(run)) {
      const std::optional<PaperErrors> paper = paperFine(run.setting, row.model);
      const GradeSummary fine = summarize(row.trials, &Trial::fine);
      fmt::format_to(std::back_inserter(text),
                     "| {} ({}) | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
                     row.model,
                     row.trials.size(),
                     run.setting.sampling,
                     run.setting.size,
                     run.setting.views,
                     paper ? plain(paper->vertex_percent, 2) : "-",
                     paper ? angles(paper->euler_deg) : "-",
                     rightOf(fine.right, fine.trials),
                     plain(fine.vertex_percent, 3),
                     angles(fine.euler_deg),
                     plain(fine.rotation_deg, 3));
    }
  }
  return text;
}

std::string memoryTable(const std::vector<SettingRun>& runs) {
  std::string text =
      "| model | sampling | size | views | paper [MB] | atlas [MB] |\n|---|---|---|---|---|---|\n";
  for (const SettingRun& run : runs) {
    for (const ModelRun& model : run.models) {
      fmt::format_to(std::back_inserter(text),
                     "| {} | {} | {} | {} | {} | {:.2f} |\n",
                     model.model,
                     run.setting.sampling,
                     run.setting.size,
                     run.setting.views,
                     orDash(paperMemoryMb(run.setting, model.model), 2),
                     model.atlas_mb);
    }
  }
  return text;
}

/// Scene to the rough pose, and what follows.
struct Seconds {
  double rough = std::numeric_limits<double>::quiet_NaN();
  double fine = std::numeric_limits<double>::quiet_NaN();
};

Seconds secondsOf(const StageTimes& times) {
  static const std::set<std::string> kFine = {"fine icp and check"};
  Seconds seconds;
  if (times.empty()) return seconds;
  seconds = {0.0, 0.0};
  for (const StageTime& time : times) {
    (kFine.contains(time.stage) ? seconds.fine : seconds.rough) += 1.0e-3 * time.ms;
  }
  return seconds;
}

std::string timeTable(const std::vector<SettingRun>& runs) {
  std::string text =
      "| model | sampling | size | views | paper: rough [s] | fine [s] | rough [s] | fine [s] | "
      "together [s] |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const SettingRun& run : runs) {
    for (const NamedTrials& row : rowsOf(run)) {
      const Seconds seconds = secondsOf(meanTimes(row.trials));
      fmt::format_to(std::back_inserter(text),
                     "| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
                     row.model,
                     run.setting.sampling,
                     run.setting.size,
                     run.setting.views,
                     orDash(paperRoughSeconds(run.setting, row.model), 2),
                     orDash(paperFineSeconds(run.setting, row.model), 2),
                     plain(seconds.rough, 3),
                     plain(seconds.fine, 3),
                     plain(seconds.rough + seconds.fine, 3));
    }
  }
  return text;
}

void appendGrade(const PoseGrade& grade, std::string& text) {
  if (grade.part < 0) {
    text += ",0,,,,,";
    return;
  }
  fmt::format_to(std::back_inserter(text),
                 ",{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}",
                 grade.right ? 1 : 0,
                 grade.vertex,
                 kDegrees * grade.rotation_rad,
                 kDegrees * grade.euler_rad.x,
                 kDegrees * grade.euler_rad.y,
                 kDegrees * grade.euler_rad.z);
}

std::string gradeHeader(const std::string& name) {
  std::string text;
  for (const char* column :
       {"right", "vertex", "rotation_deg", "euler_x_deg", "euler_y_deg", "euler_z_deg"}) {
    text += "," + name + "_" + column;
  }
  return text;
}

}  // namespace

GradeSummary summarize(const std::vector<Trial>& trials, PoseGrade Trial::*grade) {
  GradeSummary summary;
  summary.trials = static_cast<int>(trials.size());
  for (const Trial& trial : trials) {
    const PoseGrade& pose = trial.*grade;
    if (!pose.right) continue;
    ++summary.right;
    summary.vertex_percent += 100.0 * pose.vertex;
    summary.rotation_deg += kDegrees * pose.rotation_rad;
    summary.euler_deg += kDegrees * pose.euler_rad;
  }
  const double count = summary.right;  // 0 / 0 is NaN, as promised
  summary.vertex_percent /= count;
  summary.rotation_deg /= count;
  summary.euler_deg /= count;
  return summary;
}

StageTimes meanTimes(const std::vector<Trial>& trials) {
  StageTimes mean;
  int count = 0;
  for (const Trial& trial : trials) {
    if (trial.times.empty()) continue;
    ++count;
    for (const StageTime& time : trial.times) {
      const auto known = std::find_if(mean.begin(), mean.end(), [&time](const StageTime& other) {
        return other.stage == time.stage;
      });
      if (known == mean.end()) {
        mean.push_back(time);
      } else {
        known->ms += time.ms;
      }
    }
  }
  for (StageTime& time : mean) time.ms /= count;
  return mean;
}

std::vector<Trial> allTrials(const SettingRun& run) {
  std::vector<Trial> trials;
  for (const ModelRun& model : run.models) {
    trials.insert(trials.end(), model.trials.begin(), model.trials.end());
  }
  return trials;
}

std::string paperMarkdown(const std::vector<SettingRun>& runs) {
  return "### Rough pose (Tables 1 and 3)\n\nRight: vertex error below 10 % of the bounding box's "
         "diagonal; errors are means over the right ones. \"Eq. 1 alone\": the view and start with "
         "the smallest error, as the paper answers; with range differences that count without "
         "limit, "
         "as printed, and with those up to 8 px, which find what is partly hidden. \"Aligned with "
         "its view\": the best of the "
         "hypotheses after they were aligned with the points of their own reference views; nothing "
         "is rendered before that, it is what goes into refinement.\n\n" +
         roughTable(runs) + "\n### After refinement (Tables 2 and 3)\n\n" + fineTable(runs) +
         "\n### Memory (Table 4)\n\n" + memoryTable(runs) +
         "\n### Time (Table 5)\n\nThe paper's on a GTX 280, one frame; ours the mean of every "
         "fifth "
         "trial.\n\n" +
         timeTable(runs);
}

std::string trialsCsv(const std::vector<SettingRun>& runs) {
  std::string text = "sampling,size,views,model,bin,trial,visible,best_visible,score";
  for (const char* name : {"unlimited", "search", "rough", "fine"}) text += gradeHeader(name);
  text += "\n";
  for (const SettingRun& run : runs) {
    for (const ModelRun& model : run.models) {
      for (const Trial& trial : model.trials) {
        fmt::format_to(std::back_inserter(text),
                       "{},{},{},{},{},{},{:.4f},{:.4f},{:.6g}",
                       run.setting.sampling,
                       run.setting.size,
                       run.setting.views,
                       model.model,
                       trial.bin,
                       trial.number,
                       trial.visible,
                       trial.best_visible,
                       trial.score);
        for (const PoseGrade* grade :
             {&trial.unlimited, &trial.search, &trial.rough, &trial.fine}) {
          appendGrade(*grade, text);
        }
        text += "\n";
      }
    }
  }
  return text;
}

std::string settingName(const PaperSetting& setting) {
  return fmt::format("{} {} px, {} views", setting.sampling, setting.size, setting.views);
}

}  // namespace rangepose
