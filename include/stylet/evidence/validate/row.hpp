// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// Validation: compares the model with analysis, independent codes and published measurements.
namespace stylet::validate {

/// The kind of evidence against which a claim is checked; rows of one group follow each other.
enum class Group { analysis, other_code, measurements, independence };
const char* to_string(Group group);  ///< "analysis", "independent code", …: the word in JSON
const char* title(Group group);      ///< heading on the page

/// The accepted values of a row: from … to, both included. A bound that is not set does not limit. A row without any
/// bound is shown for information; it neither passes nor misses.
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

/// A curve of a row's plot. Each curve has abscissae of its own, in increasing order.
struct Curve {
  enum class Kind {
    ours,       ///< computed by this program; drawn as a line
    reference,  ///< the reference; drawn as a dashed line
    points      ///< measurements; drawn as dots
  };
  std::string label;
  std::vector<double> x{};
  std::vector<double> y{};
  Kind kind = Kind::ours;

  void add(double abscissa, double ordinate) {
    x.push_back(abscissa);
    y.push_back(ordinate);
  }
};

/// The plot of a row. A row without curves has no plot.
struct Plot {
  std::string x_label;  ///< label with unit: "base depth [mm]"
  std::string y_label;
  bool log_x = false;
  bool log_y = false;
  std::vector<Curve> curves{};
  std::optional<Accepted> band = std::nullopt;  ///< range of accepted y values; drawn shaded
};

/// The result of measuring a row.
struct Finding {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::string note{};        ///< how the value was obtained and what else the reader should know; full sentences
  std::string why_missed{};  ///< known reasons why the value is not accepted; shown only then
  Plot plot{};
  std::string skipped{};  ///< why nothing could be measured; if set, everything else is empty

  static Finding skip(std::string reason) {
    Finding finding;
    finding.skipped = std::move(reason);
    return finding;
  }
};

/// The larger of two errors. NaN if one of them is NaN, so that a row does not pass if a part was not measured.
double worse(double one, double other);

class Context;

/// A claim and how to check it. Rows are independent of each other. docs/validation.md shows how to add one.
struct RowSpec {
  std::string id;  ///< word of a-z, 0-9 and _; used for file names and by --only
  Group group{};
  std::string claim;      ///< a sentence without a full stop
  std::string reference;  ///< formula, program or publication that the value is compared with
  std::string unit;       ///< unit of the value; empty for a pure number
  Accepted accepted;
  bool quick = true;  ///< the row takes a few seconds at most, so --quick includes it
  std::function<Result<Finding>(Context&)> measure;
};

enum class Verdict { pass, missed, skipped, information, crashed };
const char* to_string(Verdict verdict);

/// A measured row.
struct Row {
  RowSpec spec;
  Verdict verdict{};
  Finding finding;  ///< in a crashed row, `note` holds the error message
  double seconds = 0.0;

  /// The finding's note, followed by the reason if the row was missed or skipped.
  [[nodiscard]] std::string note() const;
};

/// Measures one row. A measurement that fails or throws gives a crashed row.
Row measure(const RowSpec& spec, Context& context);

}  // namespace stylet::validate
