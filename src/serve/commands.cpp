// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"

#include <algorithm>
#include <limits>

namespace stylet::serve {

namespace {

using enum Command::Do;
constexpr auto kText = Argument::Type::text;
constexpr auto kNumber = Argument::Type::number;

constexpr Argument argument(std::string_view name, Argument::Type type, std::string_view unit = {},
                            std::string_view values = {}, double most = 1e6) {
  return {name, type, unit, values, most};
}

constexpr CommandRow row(Command::Do what, std::string_view word, Desk desk, While counts,
                         std::array<Argument, 2> arguments, std::string_view meaning, bool needs_needle = true) {
  return {what, word, desk, counts, arguments, meaning, needs_needle};
}

constexpr std::array kCommands{
    row(take, "take", Desk::hall, While::any, {},
        "takes the needle if nobody holds it; otherwise asks the holder for it (`asking` in the holder's "
        "status).",
        false),
    row(release, "release", Desk::hall, While::any, {},
        "gives the needle to the page that has asked longest, or to nobody; or withdraws the wish for it.", false),
    row(go_on, "go_on", Desk::hall, While::any, {},
        "lets the hand of the page that holds the needle move it again after the server has stopped it "
        "(`hand_stopped` in the status). Hands that came before are ignored."),
    row(hole, "hole", Desk::open_case, While::live, {argument("hole", kText)},
        "puts the needle at the start of an insertion through this hole of the template."),
    row(insertion, "insertion", Desk::open_case, While::live, {argument("index", kNumber)},
        "puts the needle at the start of an insertion that the scenario plans."),
    row(needle, "needle", Desk::open_case, While::live, {argument("index", kNumber)},
        "puts this needle of the plan (7) in front of the patient. Seeds that have been dropped stay."),
    row(interrupted, "interrupted", Desk::open_case, While::live, {argument("go_on", kNumber, "", "0 | 1")},
        "1 goes on with the implant that the status (3) calls `interrupted`: its seeds are in the tissue again, and "
        "the "
        "needle that it had stands in front of the patient. 0 leaves it, and the status no longer tells of it; so does "
        "the first seed of another implant."),
    row(reset, "reset", Desk::open_case, While::live, {},
        "puts the needle back to the start of its present insertion."),
    row(open_case, "case", Desk::open_case, While::any, {argument("index", kNumber)}, "opens another case."),
    row(predict, "predict", Desk::open_case, While::any, {argument("on", kNumber, "", "0 | 1")},
        "1 inserts a needle through each hole of the template for the map (6), in the background; 0 stops. "
        "Results so far stay."),
    row(drawn, "drawn", Desk::open_case, While::any, {},
        "the page has drawn everything it shows, or cannot draw in 3D. The server may now use the processors "
        "for the missing part of the picture.",
        false),
    row(pause, "pause", Desk::live, While::live, {}, "stops the simulation."),
    row(resume, "resume", Desk::live, While::live, {}, "continues the simulation."),
    row(step, "step", Desk::live, While::live, {argument("count", kNumber)},
        "takes single steps while paused, at most 100."),
    row(drop, "drop", Desk::live, While::any, {},
        "the needle pushes its next seed out of its tip, where the tip is now; or, with technique `preloaded`, "
        "the seeds that it has are held where they are and left as it is drawn back. It is refused with a "
        "notice while the tip is not in the tissue, while the simulation is paused, when the needle has no "
        "more seeds, and while a train is being left."),
    row(undo, "undo", Desk::live, While::any, {},
        "takes the last seed back; with technique `preloaded` all seeds of the needle that dropped it, or the "
        "train that is being left. It is refused with a notice during a replay."),
    row(clear, "clear", Desk::live, While::any, {},
        "takes all seeds back. It is refused with a notice during a replay."),
    row(replay, "replay", Desk::replay, While::any, {argument("name", kText)}, "shows a recording."),
    row(seek, "seek", Desk::replay, While::replay, {argument("time_s", kNumber, "s")},
        "goes to this time of the replay."),
    row(play, "play", Desk::replay, While::replay, {argument("rate", kNumber)},
        "continues the replay at `rate` times the recorded speed, at most 20; 0 stops."),
    row(live, "live", Desk::replay, While::replay, {},
        "ends the replay and returns to the needle as it was. A live insertion stands still while a recording "
        "is shown, and then continues with its curve, its events and its recording."),
    row(image, "image", Desk::pictures, While::any,
        {argument("show", kText, "", "'none' | 'transverse' | 'sagittal' | 'xray'")},
        "makes pictures (11) of this kind from now on; `none` stops."),
    row(set, "set", Desk::pictures, While::any,
        {argument("key", kText), argument("value", kNumber, "of the key", "", std::numeric_limits<double>::max())},
        "changes a key of `[probe]`, `[ultrasound]` or `[fluoroscopy]` of the open case, until another case is "
        "opened. A value out of its range is refused with a notice. In a replay the probe is where it was then "
        "until a page moves it; the live settings are back when the replay ends.")};

constexpr bool is_in_order() {
  for (std::size_t k = 0; k < kCommands.size(); ++k) {
    if (static_cast<std::size_t>(kCommands[k].what) != k) return false;
  }
  return kCommands.back().what == set;
}
static_assert(is_in_order());

}  // namespace

std::span<const CommandRow> commands() { return kCommands; }

const CommandRow& row_of(Command::Do what) { return kCommands[static_cast<std::size_t>(what)]; }

}  // namespace stylet::serve
