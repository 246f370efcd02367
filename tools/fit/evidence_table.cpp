#include "fit/evidence_table.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "core/error.h"

namespace rangepose::fit {
namespace {

constexpr std::size_t kOwnColumns = 9;

std::string headOf() {
  std::string head = "sensor,kind,scene,image,object,right,chosen,score,inner_px";
  for (std::size_t i = 1; i < kEvidenceTerms; ++i) {
    head += fmt::format(",{}", nameOf(static_cast<EvidenceTerm>(i)));
  }
  return head;
}

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

EvidenceRow rowOf(const std::vector<std::string>& cells) {
  EvidenceRow row;
  row.sensor = cells[0];
  row.kind = cells[1];
  row.scene = std::stoi(cells[2]);
  row.image = std::stoi(cells[3]);
  row.object = std::stoi(cells[4]);
  row.right = cells[5] == "1";
  row.chosen = cells[6] == "1";
  row.score = std::stod(cells[7]);
  row.inner_px = std::stod(cells[8]);
  row.terms[0] = 1.0;
  for (std::size_t i = 1; i < kEvidenceTerms; ++i)
    row.terms[i] = std::stod(cells[kOwnColumns + i - 1]);
  return row;
}

}  // namespace

std::string tableText(const std::vector<EvidenceRow>& rows) {
  std::string text = headOf() + "\n";
  for (const EvidenceRow& row : rows) {
    text += fmt::format("{},{},{},{},{},{},{},{:.4g},{:.0f}",
                        row.sensor,
                        row.kind,
                        row.scene,
                        row.image,
                        row.object,
                        row.right ? 1 : 0,
                        row.chosen ? 1 : 0,
                        row.score,
                        row.inner_px);
    for (std::size_t i = 1; i < kEvidenceTerms; ++i) text += fmt::format(",{:.4g}", row.terms[i]);
    text += "\n";
  }
  return text;
}

std::vector<EvidenceRow> readTable(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw Error(fmt::format("table {}: cannot be read", path.string()));
  std::string line;
  std::getline(file, line);
  if (line != headOf()) {
    throw Error(fmt::format("table {}: line 1: other columns; make it anew by rangepose_fit table",
                            path.string()));
  }
  std::vector<EvidenceRow> rows;
  for (int number = 2; std::getline(file, line); ++number) {
    const std::vector<std::string> cells = cellsOf(line);
    try {
      if (cells.size() != kOwnColumns + kEvidenceTerms - 1) throw std::invalid_argument("columns");
      rows.push_back(rowOf(cells));
    } catch (const std::logic_error&) {
      throw Error(fmt::format("table {}: line {}: damaged", path.string(), number));
    }
  }
  return rows;
}

}  // namespace rangepose::fit
