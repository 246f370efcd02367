// The page of a dump.
#include <algorithm>
#include <string>

#include "debug/canvas.h"
#include "debug/dump.h"

namespace rangepose::debug {
namespace {

constexpr const char* kStyle = R"(
body { margin: 0 auto; max-width: 110rem; padding: 1.5rem 2rem 4rem; background: #fafaf8; color: #24262b;
       font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.6rem; margin: 0 0 1rem; }
h2 { font-size: 1.15rem; margin: 0 0 .2rem; }
nav ol { columns: 16rem; margin: 0 0 2rem; padding-left: 1.6rem; }
a { color: #1f5fa8; }
section { margin: 0 0 2.2rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .2rem 1rem .2rem 0; border-bottom: 1px solid #dcdcd6; vertical-align: top; }
td.n { text-align: right; }
.scroll { overflow-x: auto; }
.bar { display: inline-block; height: .7em; background: #6f9bd1; }
figure { margin: 0; }
figure img { max-width: 100%; height: auto; border: 1px solid #dcdcd6; background: #fff; }
figcaption, .small { color: #62666e; font-size: .85rem; }
p { margin: 0 0 .6rem; max-width: 60rem; }
)";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string anchor(std::size_t index) { return std::string("p").append(std::to_string(index + 1)); }

std::string contents(const std::vector<DumpEntry>& entries) {
  std::string html = "<nav><ol>\n";
  for (std::size_t i = 0; i < entries.size(); ++i) {
    html += "<li><a href=\"#" + anchor(i) + "\">" + escaped(entries[i].title) + "</a></li>\n";
  }
  return html + "</ol></nav>\n";
}

std::string poseTable(const std::vector<OverlayPose>& poses) {
  if (poses.empty()) return "<section><h2>Poses</h2><p>None was found.</p></section>\n";
  std::string html =
      "<section><h2>Poses</h2><p class=\"small\">Model to camera; x right, y down, z forward.</p>\n"
      "<div class=\"scroll\"><table><tr><th>object</th><th>score</th><th>translation [mm]</th>"
      "<th>rotation, by rows</th></tr>\n";
  for (const OverlayPose& pose : poses) {
    const glm::dvec3& t = pose.camera_from_object.translation_mm;
    html += "<tr><td>" + escaped(pose.label) + "</td><td class=\"n\">" + number(pose.score, 4) +
            "</td><td>" + number(t.x, 2) + ", " + number(t.y, 2) + ", " + number(t.z, 2) +
            "</td><td>";
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        html += number(pose.camera_from_object.rotation[column][row], 5);
        html += column < 2 ? " " : (row < 2 ? "; " : "");
      }
    }
    html += "</td></tr>\n";
  }
  return html + "</table></div></section>\n";
}

std::string timeTable(const StageTimes& times) {
  if (times.empty()) return "";
  double longest = 0.0;
  double total = 0.0;
  for (const StageTime& time : times) {
    longest = std::max(longest, time.ms);
    total += time.ms;
  }
  std::string html =
      "<section><h2>Times</h2>\n<table><tr><th>stage</th><th>ms</th><th></th></tr>\n";
  for (const StageTime& time : times) {
    const double width = longest > 0.0 ? 16.0 * std::max(0.0, time.ms) / longest : 0.0;
    html += "<tr><td>" + escaped(time.stage) + "</td><td class=\"n\">" + number(time.ms, 2) +
            "</td><td><span class=\"bar\" style=\"width:" + number(width, 2) +
            "rem\"></span></td></tr>\n";
  }
  return html + "<tr><th>sum</th><td class=\"n\">" + number(total, 2) +
         "</td><td></td></tr>\n</table></section>\n";
}

std::string sensorTable(const SensorFacts& sensor) {
  const auto row = [](const char* what, const std::string& figure) {
    return std::string("<tr><td>") + what + "</td><td class=\"n\">" + figure + "</td></tr>\n";
  };
  return "<section><h2>Sensor</h2><p class=\"small\">What this image tells of it; tolerances go by "
         "the error.</p>\n<table>\n" +
         row("noise, against neighbours [mm]", number(sensor.noise_mm, 3)) +
         row("error, against smooth surfaces 19 px wide [mm]", number(sensor.error_mm, 3)) +
         row("steps of depth [mm]", number(sensor.step_mm, 3)) +
         row("jumps are smeared over [px]", number(sensor.jump_px, 2)) +
         row("lost pixels at a jump", number(sensor.hole_px, 2)) +
         row("lost pixels in all [%]", number(100.0 * sensor.lost, 2)) + "</table></section>\n";
}

std::string figure(const DumpEntry& entry, std::size_t index) {
  const std::string file = escaped(entry.file);
  return "<section id=\"" + anchor(index) + "\"><h2>" + std::to_string(index + 1) + ". " +
         escaped(entry.title) + "</h2>\n<p>" + escaped(entry.caption) + "</p>\n<figure><a href=\"" +
         file + "\"><img src=\"" + file + "\" width=\"" + std::to_string(entry.width) +
         "\" height=\"" + std::to_string(entry.height) + "\" alt=\"" + escaped(entry.title) +
         "\"></a>\n<figcaption>" + file + ", " + sizeText(entry.width, entry.height) +
         "</figcaption></figure></section>\n";
}

}  // namespace

std::string dumpPage(const std::string& title,
                     const std::vector<DumpEntry>& entries,
                     const StageTimes& times,
                     const std::vector<OverlayPose>& poses,
                     const std::optional<SensorFacts>& sensor) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      escaped(title) + "</title>\n<style>" + kStyle + "</style></head><body>\n<h1>" +
      escaped(title) + "</h1>\n";
  html += contents(entries) + poseTable(poses) + timeTable(times);
  if (sensor) html += sensorTable(*sensor);
  for (std::size_t i = 0; i < entries.size(); ++i) html += figure(entries[i], i);
  return html + "</body></html>\n";
}

}  // namespace rangepose::debug
