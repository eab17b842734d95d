// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// The model against analysis, independent codes and published measurements.
namespace stylet::validate {

/// What a claim is checked against; rows of one group follow each other.
enum class Group { analysis, other_code, measurements, independence };
const char* to_string(Group group);  ///< "analysis", "independent code", …: as JSON has it
const char* title(Group group);      ///< heading for people

/// Values that let a row pass: from … to, both included; a bound that is not there lets everything pass on its side. A
/// row without any bound is there for information and neither passes nor misses.
struct Accepted {
  std::optional<double> from;
  std::optional<double> to;

  static Accepted at_most(double to) { return {.from = {}, .to = to}; }
  static Accepted at_least(double from) { return {.from = from, .to = {}}; }
  static Accepted between(double from, double to) { return {.from = from, .to = to}; }
  static Accepted information() { return {}; }

  [[nodiscard]] bool any() const { return from || to; }
  /// NaN is never accepted.
  [[nodiscard]] bool holds(double value) const;
  /// "≤ 1e-10", "14 … 20", "for information".
  [[nodiscard]] std::string text() const;
};

/// A curve of a row's picture. Each has an abscissa of its own, increasing.
struct Curve {
  enum class Kind {
    ours,       ///< computed by this program
    reference,  ///< what it is checked against: drawn dashed
    points      ///< measurements, drawn as dots
  };
  std::string label;
  std::vector<double> x;
  std::vector<double> y;
  Kind kind = Kind::ours;

  void add(double abscissa, double ordinate) {
    x.push_back(abscissa);
    y.push_back(ordinate);
  }
};

/// A row's picture; none without curves.
struct Plot {
  std::string x_label;  ///< with unit: "base depth [mm]"
  std::string y_label;
  bool log_x = false;
  bool log_y = false;
  std::vector<Curve> curves{};
  std::optional<Accepted> band = std::nullopt;  ///< stretch of y that is accepted, shaded
};

/// What a measurement of a row found.
struct Finding {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::string note;        ///< how it was obtained, what else is worth knowing; sentences
  std::string why_missed;  ///< what is known about why, shown when the value is not accepted
  Plot plot;
  std::string skipped;  ///< why nothing could be measured; everything else is empty then

  static Finding skip(std::string reason) {
    Finding finding;
    finding.skipped = std::move(reason);
    return finding;
  }
};

/// The larger of two errors; NaN when either is, so that nothing passes that could not be measured.
double worse(double one, double other);

class Context;

/// A claim and how to check it. Rows know nothing of each other. docs/validation.md shows how to add one.
struct RowSpec {
  std::string id;  ///< word of a-z, 0-9 and _: names files, --only takes it
  Group group{};
  std::string claim;      ///< a sentence without its full stop
  std::string reference;  ///< formula, program or publication
  std::string unit;       ///< of the value; empty for a pure number
  Accepted accepted;
  bool quick = true;  ///< takes a few seconds at the most: part of --quick
  std::function<Result<Finding>(Context&)> measure;
};

enum class Verdict { pass, missed, skipped, information, crashed };
const char* to_string(Verdict verdict);

/// A row, measured.
struct Row {
  RowSpec spec;
  Verdict verdict{};
  Finding finding;  ///< of a crashed row: note holds the message
  double seconds = 0.0;

  /// The finding's note and, where they apply, why it missed or was skipped.
  [[nodiscard]] std::string note() const;
};

/// Measures one row. A measurement that fails or throws makes a crashed row, nothing else.
Row measure(const RowSpec& spec, Context& context);

}  // namespace stylet::validate
