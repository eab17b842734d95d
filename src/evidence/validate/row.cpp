// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/validate/row.hpp"

#include "need.hpp"
#include "stylet/core/survive.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <exception>

namespace stylet::validate {

const char* to_string(Group group) {
  switch (group) {
    case Group::analysis:
      return "analysis";
    case Group::other_code:
      return "independent code";
    case Group::measurements:
      return "published measurements";
    case Group::independence:
      return "mesh and step independence";
  }
  return "";
}

const char* title(Group group) {
  switch (group) {
    case Group::analysis:
      return "Comparison with analysis";
    case Group::other_code:
      return "Comparison with independent code";
    case Group::measurements:
      return "Comparison with published measurements";
    case Group::independence:
      return "Independence of mesh, time step and solver";
  }
  return "";
}

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::missed:
      return "MISSED";
    case Verdict::skipped:
      return "skipped";
    case Verdict::information:
      return "information";
    case Verdict::crashed:
      return "crashed";
  }
  return "";
}

double worse(double one, double other) { return std::isnan(one) || one > other ? one : other; }

bool Accepted::holds(double value) const {
  return !std::isnan(value) && (!from || value >= *from) && (!to || value <= *to);
}

std::string Accepted::text() const {
  if (from && to) return fmt::format("{:g} … {:g}", *from, *to);
  if (from) return fmt::format("≥ {:g}", *from);
  if (to) return fmt::format("≤ {:g}", *to);
  return "for information";
}

std::string Row::note() const {
  std::string text = finding.note;
  const auto add = [&](const std::string& more) {
    if (!more.empty()) text += (text.empty() ? "" : " ") + more;
  };
  if (verdict == Verdict::missed) add(finding.why_missed);
  if (verdict == Verdict::skipped) add(finding.skipped);
  return text;
}

Row measure(const RowSpec& spec, Context& context) {
  Row row;
  row.spec = spec;
  const auto crash = [&](const std::string& message) {
    row.verdict = Verdict::crashed;
    row.finding = {};
    row.finding.note = message;
  };
  const auto started = std::chrono::steady_clock::now();
  try {
    Result<Finding> found = spec.measure(context);
    if (found) {
      row.finding = std::move(*found);
      if (!row.finding.skipped.empty()) {
        row.verdict = Verdict::skipped;
      } else if (!spec.accepted.any()) {
        row.verdict = Verdict::information;
      } else {
        row.verdict = spec.accepted.holds(row.finding.value) ? Verdict::pass : Verdict::missed;
      }
    } else {
      crash(found.error().message());
    }
  } catch (const Skipped& skipped) {
    row.verdict = Verdict::skipped;
    row.finding = Finding::skip(skipped.why);
  } catch (const Failed& failed) {
    crash(failed.error.message());
  } catch (const std::exception&) {  // a failure of one row must not stop the others
    crash(caught_exception("").message());
  }
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return row;
}

}  // namespace stylet::validate
