// Which of the checked poses of one image go together: every pixel is explained once.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "geometry/surface_sample.h"
#include "pipeline/choice_options.h"
#include "pipeline/explained_pixels.h"
#include "pipeline/occlusion.h"
#include "pipeline/pose_distance.h"
#include "pipeline/refine.h"

namespace rangepose {

/// Keeps all poses that were found so far, whatever pass they are from, and chooses among them
/// anew: a pose that is good on its own gives way to a better one of the same surface that was
/// found later.
class Selection {
 public:
  Selection(const DepthImage& depth,
            const ReferenceDatabase& database,
            double noise_mm,
            const ChoiceOptions& options = {});

  /// Whether a pose like this one, symmetric copies included, is there already.
  bool knows(const Candidate& candidate) const;
  /// Adds checked poses, also unsure ones: they may be rivals. Of like ones the surest stays.
  void add(const std::vector<Candidate>& candidates);
  /// The best pose for the surface of the surest one, then of the surest that shares little of what
  /// it explains with one before, and so on. The confidence of each is its share of the odds of all
  /// poses of its object that explain the same surface: where two are as good as each other,
  /// neither is sure. Only those that are not hopeless, the surest first.
  std::vector<Candidate> choose() const;
  /// All poses, each as judged among the others, the surest first.
  std::vector<Candidate> known() const;
  /// Copies (see turned.h) of the poses that are not hopeless and were not turned before, to be
  /// aligned and checked; those of a pose have a `window` of their own.
  std::vector<Candidate> turnedCopies();
  /// Chosen poses turned about the line about which what is seen of them is free to turn
  /// (free_turn.h): to be checked and added.
  std::vector<Candidate> freeTurnsOfChosen() const;
  /// Takes the chosen poses out for which another one of the same surface is as likely, or nearly,
  /// and these as well, each judged by itself: to be aligned more closely and added again.
  std::vector<Candidate> takeTies();
  /// Takes the chosen poses out, each judged by itself: likewise.
  std::vector<Candidate> takeChosen();
  /// Twins of the chosen poses (geometry/twins.h): to be checked and given to addTwins().
  std::vector<Candidate> twinsOfChosen() const;
  /// Adds checked twins of chosen poses. Where there is a pose like one already, the one stays that
  /// the pixels are for: an alignment of its own may have left it a little off, by more than what
  /// tells it from its twin.
  void addTwins(const std::vector<Candidate>& twins);
  /// Takes what sure poses explain, with or without rivals, out of the mask of pixels. What unsure
  /// ones explain stays: the right pose may not have been found yet.
  void takeOut(Image<std::uint8_t>& mask) const;

 private:
  static constexpr std::int32_t kNobody = -1;
  struct Entry {
    Candidate candidate;               ///< judged among the others
    Candidate alone;                   ///< as it was added
    std::vector<std::int32_t> pixels;  ///< explained ones, by rising index
    PixelBox box;                      ///< around them
    std::vector<float> exit_mm;  ///< where rays through these leave it, of those that were found
    JudgedPixels judged;
    std::vector<Entry*> rivals;  ///< other poses of the same object for the same surface
    std::int32_t id = 0;         ///< never the same twice
    bool turned = false;         ///< whether its turned copies were given away
  };
  const ReferenceObject& objectOf(const Entry& entry) const {
    return database_.objects[static_cast<std::size_t>(entry.candidate.object)];
  }
  /// Whether it is worth being brought to rest.
  bool isSettled(const Entry& entry) const {
    return entry.candidate.confidence >= options_.settled;
  }
  const Entry* find(const Candidate& candidate) const;
  /// Among the entries before it.
  void findRivals(Entry& entry);
  void erase(const Entry* entry);
  std::vector<Candidate> take(const std::vector<Entry*>& entries);
  /// Of the depth image, around the part.
  SurfaceWindow windowOf(const Entry& entry) const;
  /// Fills in what follows from the candidate and the image.
  void describe(Entry& entry) const;
  /// Fills in where rays leave the part, if that is not known yet.
  void findExits(Entry& entry) const;
  /// Orders the poses, surest first, then judges all anew: what found parts hide of a pose does not
  /// speak against it.
  void judgeAmongOthers();
  void orderByRank();
  /// Whether they are for the same surface, by the pixels that both explain.
  bool shareMost(const Entry& a, const Entry& b) const;
  /// Log odds of a rival against the entry, see closeMm().
  double preference(const Entry& rival, const Entry& entry, double close_mm) const;
  /// Model and data that close are as near as the entry or any of its rivals comes [mm]. What tells
  /// the wrong way round from the right one may be smaller than the tolerance of the check.
  double closeMm(const Entry& entry) const;
  /// Those that share no surface, in the order of the surest pose for it.
  std::vector<Entry*> chosen() const;

  const DepthImage& depth_;
  const ReferenceDatabase& database_;
  double noise_mm_;
  ChoiceOptions options_;
  std::vector<double> mean_visible_mm2_;         ///< by object
  std::vector<PoseDistance> distances_;          ///< by object
  std::vector<AreaMoments> moments_;             ///< by object
  std::vector<std::unique_ptr<Entry>> entries_;  ///< surest first
  std::vector<Entry*> chosen_;                   ///< chosen() of all that were added
  std::int32_t added_ = 0;                       ///< entries so far
  Image<std::int32_t> owners_;                   ///< by pixel: the entry found there, or kNobody
};

}  // namespace rangepose
