#include "pipeline/selection.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "pipeline/candidates.h"
#include "pipeline/explained_pixels.h"
#include "pipeline/free_turn.h"
#include "pipeline/turned.h"

namespace rangepose {
namespace {

PixelBox boxAround(const std::vector<std::int32_t>& pixels, int width) {
  if (pixels.empty()) return {};
  PixelBox box{width, pixels.front() / width, 0, pixels.back() / width + 1};
  for (const std::int32_t at : pixels) {
    box.x0 = std::min(box.x0, at % width);
    box.x1 = std::max(box.x1, at % width + 1);
  }
  return box;
}

}  // namespace

Selection::Selection(const DepthImage& depth,
                     const ReferenceDatabase& database,
                     double noise_mm,
                     const ChoiceOptions& options)
    : depth_(depth),
      database_(database),
      noise_mm_(noise_mm),
      options_(options),
      distances_(database.objects.begin(), database.objects.end()),
      owners_(depth.depth_mm.width(), depth.depth_mm.height(), kNobody) {
  for (const ReferenceObject& object : database.objects) {
    moments_.push_back(areaMoments(object.mesh));
    mean_visible_mm2_.push_back(meanVisibleArea(object));
  }
}

const Selection::Entry* Selection::find(const Candidate& candidate) const {
  const PoseDistance& distance = distances_[static_cast<std::size_t>(candidate.object)];
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const auto& entry) {
    return entry->candidate.object == candidate.object &&
           distance.below(options_.same, entry->candidate.pose, candidate.pose);
  });
  return found == entries_.end() ? nullptr : found->get();
}

bool Selection::knows(const Candidate& candidate) const { return find(candidate) != nullptr; }

void Selection::add(const std::vector<Candidate>& candidates) {
  std::vector<Entry*> added;
  for (const Candidate& candidate : candidates) {
    if (!(candidate.confidence >= options_.faint)) continue;
    if (const Entry* known = find(candidate)) {
      if (known->alone.rank >= candidate.rank) continue;
      std::erase(added, known);
      erase(known);
    }
    Entry& entry = *entries_.emplace_back(std::make_unique<Entry>());
    entry.candidate = entry.alone = candidate;
    entry.id = added_++;
    added.push_back(&entry);
  }
  parallelForEach(added.size(), 1, [&](std::size_t i) { describe(*added[i]); });
  for (Entry* entry : added) findRivals(*entry);
  judgeAmongOthers();
  chosen_ = chosen();
}

void Selection::findRivals(Entry& entry) {
  for (const auto& other : entries_) {
    if (other.get() == &entry) return;
    if (other->candidate.object != entry.candidate.object || !shareMost(*other, entry)) continue;
    other->rivals.push_back(&entry);
    entry.rivals.push_back(other.get());
  }
}

void Selection::erase(const Entry* entry) {
  for (Entry* rival : entry->rivals) std::erase(rival->rivals, entry);
  std::erase(chosen_, entry);
  std::erase_if(entries_, [&](const auto& one) { return one.get() == entry; });
}

void Selection::orderByRank() {
  std::stable_sort(entries_.begin(), entries_.end(), [](const auto& a, const auto& b) {
    return a->candidate.rank > b->candidate.rank;
  });
}

void Selection::judgeAmongOthers() {
  for (const auto& entry : entries_) entry->candidate = entry->alone;
  orderByRank();
  FoundParts found(depth_.depth_mm.size());
  std::fill(owners_.begin(), owners_.end(), kNobody);
  std::vector<Entry*> hiding = chosen();
  std::erase_if(hiding,
                [&](const Entry* one) { return one->candidate.confidence < options_.found; });
  parallelForEach(hiding.size(), 1, [&](std::size_t i) { findExits(*hiding[i]); });
  for (const Entry* entry : hiding) {
    found.add(entry->pixels, entry->exit_mm);
    for (const std::int32_t at : entry->pixels) owners_.data()[at] = entry->id;
  }
  for (const auto& entry : entries_) {
    const ReferenceObject& object = objectOf(*entry);
    const double mean_mm2 = mean_visible_mm2_[static_cast<std::size_t>(entry->alone.object)];
    if (entry->alone.check.explained_mm2 < options_.hidden_from * mean_mm2) continue;
    const double slack_mm = options_.slack * toleranceFor(object, noise_mm_);
    const double share = found.coveredShare(entry->pixels, entry->judged.buried, slack_mm);
    if (share > 0.0) {
      entry->candidate.check = withCovered(entry->alone.check, share);
      setTerm(entry->candidate, EvidenceTerm::kBuried, buriedTerm(entry->candidate.check));
    }
  }
  orderByRank();
}

SurfaceWindow Selection::windowOf(const Entry& entry) const {
  const ReferenceObject& object = objectOf(entry);
  const int all = std::max(depth_.camera.width, depth_.camera.height);
  return windowAround(
      depth_.camera, entry.candidate.pose * object.center_mm, object.radius_mm, all);
}

void Selection::describe(Entry& entry) const {
  const ReferenceObject& object = objectOf(entry);
  const SurfaceWindow window = windowOf(entry);
  const Image<SurfaceTexel> surface =
      host::renderSurface(object.mesh, depth_.camera, entry.candidate.pose, window);
  const CheckOptions options = checkOptionsFor(object, noise_mm_);
  entry.judged = judgedPixels(surface, window, depth_, options);
  entry.pixels = explainedPixels(surface, window, depth_, sameSurfaceMm(options.tolerance_mm));
  entry.box = boxAround(entry.pixels, depth_.camera.width);
}

void Selection::findExits(Entry& entry) const {
  if (entry.exit_mm.size() == entry.pixels.size()) return;
  entry.exit_mm = exitDepths(
      objectOf(entry).mesh, entry.candidate.pose, depth_.camera, windowOf(entry), entry.pixels);
}

bool Selection::shareMost(const Entry& a, const Entry& b) const {
  const double wanted =
      options_.rival * static_cast<double>(std::max(a.pixels.size(), b.pixels.size()));
  const int width = std::min(a.box.x1, b.box.x1) - std::max(a.box.x0, b.box.x0);
  const int height = std::min(a.box.y1, b.box.y1) - std::max(a.box.y0, b.box.y0);
  const double most = static_cast<double>(std::min(a.pixels.size(), b.pixels.size()));
  if (most < wanted || width <= 0 || height <= 0 || static_cast<double>(width) * height < wanted)
    return false;
  std::size_t count = 0;
  auto at = b.pixels.begin();
  for (const std::int32_t pixel : a.pixels) {
    while (at != b.pixels.end() && *at < pixel) ++at;
    if (at != b.pixels.end() && *at == pixel) ++count;
  }
  return static_cast<double>(count) >= wanted;
}

double Selection::preference(const Entry& rival, const Entry& entry, double close_mm) const {
  // Each of them may look right by itself; what decides is what tells them apart. What belongs to
  // another part says nothing about these.
  const auto counts = [&](std::int32_t at) {
    const std::int32_t owner = owners_.data()[at];
    return owner == kNobody || owner == entry.id ||
           std::any_of(entry.rivals.begin(), entry.rivals.end(), [&](const Entry* one) {
             return one->id == owner;
           });
  };
  return votesBetween(rival.judged.near, entry.judged.near, close_mm, counts).logOdds();
}

double Selection::closeMm(const Entry& entry) const {
  double residual_mm = entry.candidate.check.residual_mm;
  for (const Entry* rival : entry.rivals)
    residual_mm = std::min(residual_mm, rival->candidate.check.residual_mm);
  // The mean of the absolute value of x from N(0, s^2) is 0.8 s.
  const double sigma_mm = std::max(residual_mm / 0.8, noise_mm_);
  const ReferenceObject& object = objectOf(entry);
  return std::min(std::max(options_.close * sigma_mm, options_.at_rest * object.diameter_mm),
                  toleranceFor(object, noise_mm_));
}

std::vector<Selection::Entry*> Selection::chosen() const {
  std::vector<Entry*> entries;
  std::vector<std::uint8_t> taken(depth_.depth_mm.size(), 0);
  const auto isFree = [&](const Entry& entry) {
    const auto shared = std::count_if(entry.pixels.begin(), entry.pixels.end(), [&](int at) {
      return taken[static_cast<std::size_t>(at)] != 0;
    });
    return static_cast<double>(shared) <=
           options_.shared * static_cast<double>(entry.pixels.size());
  };
  for (const auto& entry : entries_) {
    if (!(entry->candidate.confidence >= options_.listed) || !isFree(*entry)) continue;
    const double close_mm = closeMm(*entry);
    Entry* best = entry.get();
    double most = 0.0;
    for (Entry* rival : entry->rivals) {
      const double its = preference(*rival, *entry, close_mm);
      if (!(its > most) || !isFree(*rival)) continue;
      best = rival;
      most = its;
    }
    for (const std::int32_t at : best->pixels) taken[static_cast<std::size_t>(at)] = 1;
    entries.push_back(best);
  }
  return entries;
}

std::vector<Candidate> Selection::choose() const {
  std::vector<Candidate> candidates;
  for (const Entry* entry : chosen_) {
    const double odds = std::exp(entry->candidate.rank);
    const double close_mm = closeMm(*entry);
    double all = 1.0 + odds;
    for (const Entry* rival : entry->rivals)
      all += odds * std::exp(preference(*rival, *entry, close_mm));
    const double confidence = odds / all;
    if (!(confidence >= options_.listed)) continue;
    candidates.push_back(entry->candidate);
    candidates.back().confidence = confidence;
  }
  std::stable_sort(
      candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.confidence > b.confidence;
      });
  return candidates;
}

std::vector<Candidate> Selection::known() const {
  std::vector<Candidate> candidates;
  for (const auto& entry : entries_) candidates.push_back(entry->candidate);
  return candidates;
}

std::vector<Candidate> Selection::turnedCopies() {
  std::vector<Entry*> turned;
  // Copies of the surest pose for a surface serve rivals that are far less sure as well.
  for (const auto& entry : entries_) {
    if (entry->turned || entry->candidate.confidence < options_.turned) continue;
    const auto isSurer = [&](const Entry* rival) {
      return rival->turned && rival->candidate.rank >= entry->candidate.rank;
    };
    if (entry->candidate.confidence < options_.turned_again &&
        std::any_of(entry->rivals.begin(), entry->rivals.end(), isSurer))
      continue;
    entry->turned = true;
    turned.push_back(entry.get());
  }
  std::vector<std::vector<Candidate>> copies_of(turned.size());
  parallelForEach(turned.size(), 1, [&](std::size_t i) {
    const Entry& entry = *turned[i];
    copies_of[i] =
        rangepose::turnedCopies(entry.candidate,
                                entry.pixels,
                                depth_,
                                objectOf(entry),
                                moments_[static_cast<std::size_t>(entry.candidate.object)]);
    for (Candidate& copy : copies_of[i]) copy.window = static_cast<int>(i);
  });
  std::vector<Candidate> copies;
  for (const std::vector<Candidate>& own : copies_of)
    copies.insert(copies.end(), own.begin(), own.end());
  return copies;
}

std::vector<Candidate> Selection::freeTurnsOfChosen() const {
  std::vector<std::vector<Candidate>> turns_of(chosen_.size());
  parallelForEach(chosen_.size(), 1, [&](std::size_t i) {
    const Entry& entry = *chosen_[i];
    if (!isSettled(entry)) return;
    const ReferenceObject& object = objectOf(entry);
    const SurfaceWindow window = windowOf(entry);
    const double tolerance_mm = toleranceFor(object, noise_mm_);
    const std::optional<FreeTurn> turn =
        freestTurn(host::renderSurface(object.mesh, depth_.camera, entry.alone.pose, window),
                   window,
                   depth_,
                   object,
                   entry.alone.pose,
                   tolerance_mm);
    if (turn && turn->change_mm <= options_.free * tolerance_mm)
      turns_of[i] = turnedAbout(*turn, entry.alone, options_.free_turns);
  });
  std::vector<Candidate> turns;
  for (const std::vector<Candidate>& own : turns_of)
    turns.insert(turns.end(), own.begin(), own.end());
  return turns;
}

std::vector<Candidate> Selection::takeTies() {
  std::vector<Entry*> ties;
  const auto tie = [&](Entry* entry) {
    if (std::find(ties.begin(), ties.end(), entry) == ties.end()) ties.push_back(entry);
  };
  for (Entry* entry : chosen_) {
    if (!isSettled(*entry)) continue;
    const double close_mm = closeMm(*entry);
    for (Entry* rival : entry->rivals) {
      if (std::abs(preference(*rival, *entry, close_mm)) > options_.tie) continue;
      tie(entry);
      tie(rival);
    }
  }
  return take(ties);
}

std::vector<Candidate> Selection::takeChosen() {
  std::vector<Entry*> entries = chosen_;
  std::erase_if(entries, [&](const Entry* one) { return !isSettled(*one); });
  return take(entries);
}

std::vector<Candidate> Selection::take(const std::vector<Entry*>& entries) {
  std::vector<Candidate> candidates;
  for (const Entry* entry : entries) {
    candidates.push_back(entry->alone);
    erase(entry);
  }
  return candidates;
}

std::vector<Candidate> Selection::twinsOfChosen() const {
  std::vector<Candidate> twins;
  for (const Entry* entry : chosen_) {
    if (!isSettled(*entry)) continue;
    for (const Pose& twin : objectOf(*entry).twins) {
      twins.push_back(entry->alone);
      twins.back().pose = entry->alone.pose * twin;
    }
  }
  return twins;
}

void Selection::addTwins(const std::vector<Candidate>& twins) {
  std::vector<Candidate> better;
  for (const Candidate& twin : twins) {
    const Entry* known = find(twin);
    if (known != nullptr) {
      Entry entry;
      entry.candidate = twin;
      describe(entry);
      const auto all = [](std::int32_t) { return true; };
      const Votes votes = votesBetween(entry.judged.near, known->judged.near, closeMm(*known), all);
      if (votes.first < votes.second) continue;
      erase(known);
    }
    better.push_back(twin);
  }
  add(better);
}

void Selection::takeOut(Image<std::uint8_t>& mask) const {
  for (const Entry* entry : chosen_) {
    if (entry->candidate.confidence < options_.sure) continue;
    for (const std::int32_t at : entry->pixels) mask.data()[at] = 0;
  }
}

}  // namespace rangepose
