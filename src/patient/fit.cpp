// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/fit.hpp"

#include "fit_structures.hpp"

#include "stylet/mesher/body_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace stylet {

namespace {

using fit::Structure;
using fit::Structures;

// Bounds of the rules. docs/formats.md gives the reason and the source of each.
constexpr double kSmallestGland_cc = 2.0, kLargestGland_cc = 1500.0;
constexpr double kSmallGland_cc = 8.0, kLargeGland_cc = 250.0;
constexpr double kLongGland_mm = 120.0;
constexpr double kFarFromOrgan_mm = 30.0;
constexpr double kFarFromUrethra_mm = 10.0;
constexpr double kOrganInGland = 0.5, kOutsideBody = 0.5, kPartlyOutsideBody = 0.1;  // shares of a volume
constexpr double kBladderBelow_mm = 10.0, kOrganOnWrongSide_mm = 5.0;
constexpr double kNarrowBody_mm = 120.0, kWideBody_mm = 700.0;

using enum FitVerdict;
constexpr std::array kRules{
    FitRule{"gland_volume_possible", "2 to 1500 cc", refuse, refuse},
    FitRule{"gland_volume_usual", "8 to 250 cc", warn, warn},
    FitRule{"gland_length", "at most 120 mm", warn, warn},
    FitRule{"other_body_part", "an organ of the male pelvis beside organs from elsewhere", refuse, warn},
    FitRule{"female_pelvis", "no uterus, cervix, vagina or ovary", refuse, warn},
    FitRule{"gland_near_organs", "at most 30 mm from the bladder and from the rectum", refuse, warn},
    FitRule{"organ_in_gland", "at most half of the bladder and of the rectum in the gland", refuse, warn},
    FitRule{"gland_in_body", "at least half of the gland in the body", refuse, refuse},
    FitRule{"gland_wholly_in_body", "at least 90 % of the gland in the body", warn, warn},
    FitRule{"urethra_in_gland", "the urethra at most 10 mm from the gland", warn, warn},
    FitRule{"bladder_above_gland", "centre of the bladder at most 10 mm below the gland's", warn, warn},
    FitRule{"rectum_behind_gland", "centre of the rectum at most 5 mm in front of the gland's", warn, warn},
    FitRule{"bladder_before_rectum", "centre of the bladder at most 5 mm behind the rectum's", warn, warn},
    FitRule{"pubis_before_gland", "centre of the pubic arch at most 5 mm behind the gland's", warn, warn},
    FitRule{"left_and_right", "the left femur on the patient's left", warn, warn},
    FitRule{"body_width", "120 to 700 mm", note, note}};

bool is_pelvic(std::string_view region) {
  constexpr std::array<std::string_view, 12> pelvic{
      "bladder", "rectum",       "rectal_lumen",    "urethra",         "seminal_vesicles", "pubic_arch",
      "levator", "central_zone", "peripheral_zone", "transition_zone", "anterior_stroma",  "periprostatic_fat"};
  return std::find(pelvic.begin(), pelvic.end(), region) != pelvic.end();
}

/// Adds a structure to another one that stands for both.
void join(Structure& sum, const Structure& part) {
  sum.name += (sum.name.empty() ? "'" : ", '") + part.name + "'";
  sum.volume_cc += part.volume_cc;
  sum.step_mm = std::max(sum.step_mm, part.step_mm);
  if (!part.box.isEmpty()) sum.box.extend(part.box);
  sum.points.insert(sum.points.end(), part.points.begin(), part.points.end());
  sum.guessed = sum.guessed && part.guessed;
  sum.insisted = sum.insisted || part.insisted;
}

/// All structures for which `wanted` holds, as one; its name is a list of quoted names, empty if there is none.
Structure joined(const Structures& structures, const auto& wanted) {
  Structure sum{.guessed = true};
  for (const Structure& s : structures.all) {
    if (wanted(s.region)) join(sum, s);
  }
  return sum;
}

/// Distance between two structures [mm], 0 where they touch.
double gap_mm(const Structure& a, const Structure& b) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& p : a.points) {
    for (const Vec3& q : b.points) least = std::min(least, (p - q).squaredNorm());
  }
  return std::max(0.0, std::sqrt(least) - 0.5 * (a.spacing_mm() + b.spacing_mm()));
}

/// Share of the points of `a` that lie in `b`: a point of `b` is within its cell's half diagonal.
double share_in(const Structure& a, const Structure& b) {
  const double near = 0.9 * std::max(b.step_mm, b.spacing_mm());
  const auto in = std::count_if(a.points.begin(), a.points.end(), [&](const Vec3& p) {
    return std::any_of(b.points.begin(), b.points.end(),
                       [&](const Vec3& q) { return (p - q).squaredNorm() <= near * near; });
  });
  return static_cast<double>(in) / static_cast<double>(a.points.size());
}

/// The judgement of one patient.
class Judgement {
 public:
  Judgement(Structures structures, const FitOptions& options)
      : structures_(std::move(structures)), scale_(options.scale > 0.0 ? options.scale : 1.0) {
    const auto only = [&](std::string_view region) {
      return joined(structures_, [&](const std::string& r) { return r == region; });
    };
    gland_ = only("prostate");
    if (gland_.name.empty()) gland_ = joined(structures_, [](const std::string& r) { return is_target_region(r); });
    if (gland_.name.empty()) {  // without a target the labels together are taken as the gland
      gland_ = joined(structures_, [](const std::string& r) { return r.starts_with("label_"); });
      unnamed_ = !gland_.name.empty();
    }
    bladder_ = only("bladder");
    rectum_ = only("rectum");
    urethra_ = only("urethra");
    pubis_ = only("pubic_arch");
    body_ = only("body");
    left_ = only("femur_left");
    right_ = only("femur_right");
  }

  std::vector<FitFinding> made() {
    if (gland_.name.empty()) return {};
    judge_size();
    if (unnamed_) return findings_;
    judge_company();
    if (!gland_.is_measured()) return findings_;
    judge_neighbours();
    judge_body();
    judge_axes();
    return findings_;
  }

 private:
  void find(std::string_view rule, std::string what, std::string cure = {}) {
    const auto* const found =
        std::find_if(kRules.begin(), kRules.end(), [&](const FitRule& r) { return rule == r.name; });
    FitVerdict verdict = gland_.guessed ? found->if_guessed : found->if_named;
    if (verdict == refuse && (gland_.insisted || unnamed_)) verdict = warn;
    if (cure.empty()) cure = gland_.insisted || unnamed_ ? "Look whether it is the gland" : insistence();
    findings_.push_back({std::string(rule), verdict, std::move(what), std::move(cure)});
  }

  /// The cure for a gland on which the user has not insisted yet.
  [[nodiscard]] std::string insistence() const {
    const bool one = gland_.name.find("', '") == std::string::npos;
    const std::string name = one ? gland_.name.substr(1, gland_.name.size() - 2) : "NAME";
    return fmt::format(
        "Give a patient with a prostate, or insist that {} is one: --region '{}=prostate' (in a scenario: \"{}\" = "
        "\"prostate\" below [patient.regions])",
        gland_.name, name, name);
  }

  [[nodiscard]] std::string gland() const {
    return unnamed_ ? fmt::format("the {}s together, which are taken as the gland,", structures_.kind)
                    : fmt::format("the gland ({})", gland_.name);
  }

  /// The cure if lengths are in another unit; empty if no usual unit makes the gland's volume usual.
  [[nodiscard]] std::string other_unit() const {
    for (const double factor : {10.0, 0.1, 1000.0, 0.001}) {
      const double volume = gland_.volume_cc * factor * factor * factor;
      if (volume < kSmallGland_cc || volume > kLargeGland_cc) continue;
      const std::string fits =
          fmt::format("It would have {:.3g} cc if all lengths were {:g} times as long", volume, factor);
      return structures_.has_unit
                 ? fmt::format("{}: set patient.scale = {:g} (stylet mesh and info: --scale {:g})", fits,
                               scale_ * factor, scale_ * factor)
                 : fmt::format("{}: write the file in mm (patient.scale is for mesh files only)", fits);
    }
    return {};
  }

  void judge_size() {
    if (!gland_.is_measured()) return;
    const double v = gland_.volume_cc;
    const std::string has =
        v < 0.1 ? fmt::format("{} has {:.2g} cc", gland(), v) : fmt::format("{} has {:.1f} cc", gland(), v);
    if (v < kSmallestGland_cc || v > kLargestGland_cc) {
      find("gland_volume_possible",
           fmt::format("{}, but no adult's prostate has less than {:g} or more than {:g} cc", has, kSmallestGland_cc,
                       kLargestGland_cc),
           other_unit());
    } else if (v < kSmallGland_cc || v > kLargeGland_cc) {
      find("gland_volume_usual",
           fmt::format("{}, but nearly all prostates have {:g} to {:g} cc", has, kSmallGland_cc, kLargeGland_cc),
           "Look whether this structure is the gland");
    }
    const double length = gland_.box.sizes().maxCoeff();
    if (length > kLongGland_mm && v <= kLargestGland_cc && !unnamed_) {
      find("gland_length",
           fmt::format("{} is {:.0f} mm long, a prostate at most {:g} mm", gland(), length, kLongGland_mm),
           "Look whether lymph nodes or other parts belong to this structure, and name the gland alone");
    }
  }

  void judge_company() {
    std::vector<std::string> elsewhere, female;
    bool pelvic = false;
    for (const Structure& s : structures_.all) {
      pelvic = pelvic || is_pelvic(s.region);
      const bool known = !canonical_region(s.region).empty();  // a label or region without a role keeps its own name
      const BodyPart part = known ? BodyPart::none : body_part(s.name);
      if (part == BodyPart::female) female.push_back("'" + s.name + "'");
      if (part == BodyPart::other || s.region.starts_with("femur_")) elsewhere.push_back("'" + s.name + "'");
    }
    const auto listed = [](std::vector<std::string>& names) {
      constexpr std::size_t most = 6;
      const std::size_t more = names.size() > most ? names.size() - most : 0;
      names.resize(names.size() - more);
      return fmt::format("{}{}", fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
    };
    if (!elsewhere.empty() && !pelvic) {
      find("other_body_part",
           fmt::format("beside {} the file has {}, but no bladder, rectum or other organ of the male "
                       "pelvis",
                       gland(), listed(elsewhere)));
    }
    if (!female.empty())
      find("female_pelvis", fmt::format("beside {} the file has {}: this is a female pelvis", gland(), listed(female)));
  }

  void judge_neighbours() {
    for (const auto& [organ, word] : {std::pair{&bladder_, "bladder"}, std::pair{&rectum_, "rectum"}}) {
      if (!organ->is_measured()) continue;
      const double gap = gap_mm(gland_, *organ);
      if (gap > kFarFromOrgan_mm) {
        find("gland_near_organs", fmt::format("{} is {:.0f} mm away from the {} ({}), but a prostate is next to it",
                                              gland(), gap, word, organ->name));
      } else if (const double share = share_in(*organ, gland_); share > kOrganInGland) {
        find("organ_in_gland",
             fmt::format("{:.0f} % of the {} ({}) lie in {}", 100.0 * share, word, organ->name, gland()));
      }
    }
    if (!urethra_.is_measured()) return;
    if (const double gap = gap_mm(gland_, urethra_); gap > kFarFromUrethra_mm) {
      find("urethra_in_gland",
           fmt::format("the urethra ({}) is {:.0f} mm away from {}, but it runs through a prostate", urethra_.name, gap,
                       gland()),
           "Look whether both structures have the same coordinates");
    }
  }

  void judge_body() {
    if (body_.box.isEmpty()) return;
    const bool by_points = !structures_.apart && body_.is_measured();
    const double inside = by_points ? share_in(gland_, body_) : body_.box.contains(gland_.centre()) ? 1.0 : 0.0;
    if (inside < 1.0 - kOutsideBody) {
      find("gland_in_body", fmt::format("{} lies outside of the body ({})", gland(), body_.name));
    } else if (inside < 1.0 - kPartlyOutsideBody) {
      find("gland_wholly_in_body",
           fmt::format("{:.0f} % of {} lie outside of the body ({})", 100.0 * (1.0 - inside), gland(), body_.name),
           "Look at the contours of the body");
    }
    const double width = body_.box.sizes().x();
    if (width < kNarrowBody_mm || width > kWideBody_mm) {
      find("body_width", fmt::format("the body ({}) is {:.0f} mm wide, which no man's pelvis is", body_.name, width),
           width < kNarrowBody_mm ? "This does no harm for a phantom, or a part that is cut out"
                                  : "Look at the contours of the body and at the unit of length");
    }
  }

  void judge_axes() {
    const Vec3 g = gland_.centre();
    const bool behind_rectum =
        bladder_.is_measured() && rectum_.is_measured() && bladder_.centre().y() > rectum_.centre().y();
    const std::string flipped =
        std::string(behind_rectum ? "Look whether bladder and rectum are exchanged, or the axes of the file are flipped"
                                  : "The axes may be flipped: look at the orientation of the file") +
        " (DICOM LPS: x to the left, y to posterior, z to superior)";
    const auto away = [&](const char* rule, const Structure& organ, const char* word, double mm, double bound,
                          const char* side, const char* expected) {
      if (!organ.is_measured() || mm <= bound) return;
      find(rule,
           fmt::format("the centre of the {} ({}) is {:.0f} mm {} of the centre of {}, but a {} is {}", word,
                       organ.name, mm, side, gland(), word, expected),
           flipped);
    };
    away("bladder_above_gland", bladder_, "bladder", g.z() - bladder_.centre().z(), kBladderBelow_mm, "inferior",
         "superior of a prostate");
    away("rectum_behind_gland", rectum_, "rectum", g.y() - rectum_.centre().y(), kOrganOnWrongSide_mm, "anterior",
         "posterior of a prostate");
    if (behind_rectum && bladder_.centre().y() - rectum_.centre().y() > kOrganOnWrongSide_mm) {
      find("bladder_before_rectum",
           fmt::format("the bladder ({}) is behind the rectum ({})", bladder_.name, rectum_.name), flipped);
    }
    away("pubis_before_gland", pubis_, "pubic arch", pubis_.centre().y() - g.y(), kOrganOnWrongSide_mm, "posterior",
         "anterior of a prostate");
    if (left_.is_measured() && right_.is_measured() && left_.centre().x() < right_.centre().x()) {
      find("left_and_right",
           fmt::format("the left femur ({}) is on the patient's right of the right one ({})", left_.name, right_.name),
           "Left and right may be flipped: look at the orientation of the file (DICOM LPS: x to the patient's left)");
    }
  }

  Structures structures_;
  double scale_ = 1.0;
  Structure gland_, bladder_, rectum_, urethra_, pubis_, body_, left_, right_;
  bool unnamed_ = false;  ///< the gland is all labels together
  std::vector<FitFinding> findings_;
};

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace

std::span<const FitRule> fit_rules() { return kRules; }

std::string FitFinding::message() const { return fmt::format("{} (rule {}). {}.", capitalised(what), rule, cure); }

std::vector<FitFinding> judge_fit(const PatientInput& input, const FitOptions& options) {
  return Judgement(fit::structures_of(input, options.names), options).made();
}

std::optional<Error> refusal(std::span<const FitFinding> findings, const std::string& where) {
  std::vector<std::string> what, cures;
  for (const FitFinding& finding : findings) {
    if (finding.verdict != refuse) continue;
    what.push_back(fmt::format("{} (rule {})", finding.what, finding.rule));
    if (std::find(cures.begin(), cures.end(), finding.cure) == cures.end()) cures.push_back(finding.cure);
  }
  if (what.empty()) return std::nullopt;
  return input_error(where, fmt::format("this is not a patient for this program: {}", fmt::join(what, "; ")),
                     fmt::format("{}", fmt::join(cures, ". ")));
}

}  // namespace stylet
