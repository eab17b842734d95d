// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace stylet::serve {

/// A command of a page.
struct Command {
  enum class Do {
    take,
    release,
    go_on,
    hole,
    insertion,
    needle,
    interrupted,
    reset,
    open_case,
    predict,
    drawn,
    pause,
    resume,
    step,
    drop,
    undo,
    clear,
    replay,
    seek,
    play,
    live,
    image,
    set
  };
  Do what{};
  std::string text;     ///< the argument that is a text
  double number = 0.0;  ///< the argument that is a number
};

/// A command with the viewer that gave it.
struct Request {
  Command command;
  std::uint64_t viewer = 0;
};

/// An argument of a command: a key of its JSON.
struct Argument {
  enum class Type { none, text, number };
  std::string_view name;
  Type type = Type::none;
  std::string_view unit;    ///< of a number; empty: it has none
  std::string_view values;  ///< that have a meaning, as a type of TypeScript; empty: any
  double most = 1e6;        ///< a number that is larger than this, or smaller than its negative, is malformed
};

/// The part of the server that carries a command out.
enum class Desk { hall, open_case, live, replay, pictures };

/// The time at which a command counts, by what has the audience; at other times it is ignored.
enum class While { any, live, replay };

/// A row of the table of commands.
struct CommandRow {
  Command::Do what;
  std::string_view word;  ///< in the protocol
  Desk desk;
  While counts;
  std::array<Argument, 2> arguments;
  std::string_view meaning;  ///< Markdown
  bool needs_needle = true;  ///< it is refused to a page that does not hold the needle
};

/// All commands, in the order of Command::Do. The decoder, the session and the rooms use this table, and the page's
/// `web/live/src/commands.ts` and the list in docs/live_protocol.md are made of it (test Commands.*).
std::span<const CommandRow> commands();
/// The row of a command.
const CommandRow& row_of(Command::Do what);

}  // namespace stylet::serve
