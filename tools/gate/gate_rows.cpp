#include "gate/gate_rows.h"

#include <filesystem>
#include <map>
#include <utility>

namespace rangepose::gate {
namespace {

using CellList = std::vector<const GateCell*>;

/// The cells of each sensor, in the order of the run.
std::vector<CellList> bySensor(const std::vector<GateCell>& cells) {
  std::vector<CellList> groups;
  for (const GateCell& cell : cells) {
    if (groups.empty() || groups.back().front()->sensor != cell.sensor) groups.emplace_back();
    groups.back().push_back(&cell);
  }
  return groups;
}

CellList allOf(const std::vector<GateCell>& cells) {
  CellList all;
  for (const GateCell& cell : cells) all.push_back(&cell);
  return all;
}

GateFigures figuresOf(const CellList& cells, std::size_t system) {
  std::vector<const ImageTally*> tallies;
  for (const GateCell* cell : cells) {
    for (const ImageTally& tally : cell->systems.at(system).all) tallies.push_back(&tally);
  }
  return gateFigures(tallies);
}

void addCell(std::vector<GateRow>& rows, const GateCell& cell, const std::vector<System>& systems) {
  for (std::size_t s = 0; s < systems.size(); ++s) {
    rows.push_back({cell.sensor, cell.kind.name, "", systems[s].name, figuresOf({&cell}, s)});
  }
  for (std::size_t part = 0; part < cell.kind.parts.size(); ++part) {
    const std::string name = std::filesystem::path(cell.kind.parts[part]).filename().string();
    for (std::size_t s = 0; s < systems.size(); ++s) {
      if (cell.systems[s].of_part.empty()) continue;
      rows.push_back({cell.sensor,
                      cell.kind.name,
                      name,
                      systems[s].name,
                      gateFigures(cell.systems[s].of_part.at(part))});
    }
  }
}

void addAll(std::vector<GateRow>& rows,
            const std::string& sensor,
            const CellList& cells,
            const std::vector<System>& systems) {
  for (std::size_t s = 0; s < systems.size(); ++s) {
    rows.push_back({sensor, kAllKinds, "", systems[s].name, figuresOf(cells, s)});
  }
}

/// The same parts lie in a bin of a kind whatever the sensor and the image: one unit.
GateDifference differenceOf(const CellList& cells, std::size_t after) {
  PairedTallies pairs;
  std::map<std::pair<std::string, int>, std::size_t> units;
  for (const GateCell* cell : cells) {
    const std::vector<ImageTally>& before_images = cell->systems.at(0).all;
    const std::vector<ImageTally>& after_images = cell->systems.at(after).all;
    for (std::size_t i = 0; i < before_images.size(); ++i) {
      pairs.before.push_back(&before_images[i]);
      pairs.after.push_back(&after_images.at(i));
      const std::pair<std::string, int> bin = {cell->kind.name, before_images[i].id.first};
      pairs.units.push_back(units.try_emplace(bin, units.size()).first->second);
    }
  }
  return gateDifference(pairs);
}

}  // namespace

std::vector<GateRow> gateRows(const std::vector<GateCell>& cells,
                              const std::vector<System>& systems) {
  std::vector<GateRow> rows;
  const std::vector<CellList> groups = bySensor(cells);
  for (const CellList& group : groups) {
    for (const GateCell* cell : group) addCell(rows, *cell, systems);
    addAll(rows, group.front()->sensor, group, systems);
  }
  if (groups.size() > 1) addAll(rows, kAllSensors, allOf(cells), systems);
  return rows;
}

std::vector<GateDifferenceRow> differenceRows(const std::vector<GateCell>& cells,
                                              std::size_t after) {
  std::vector<GateDifferenceRow> rows;
  const std::vector<CellList> groups = bySensor(cells);
  for (const CellList& group : groups) {
    for (const GateCell* cell : group) {
      rows.push_back({cell->sensor, cell->kind.name, differenceOf({cell}, after)});
    }
    rows.push_back({group.front()->sensor, kAllKinds, differenceOf(group, after)});
  }
  if (groups.size() > 1)
    rows.push_back({kAllSensors, kAllKinds, differenceOf(allOf(cells), after)});
  return rows;
}

}  // namespace rangepose::gate
