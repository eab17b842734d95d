// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/result.hpp"

#include "stylet/core/printable.hpp"
#include "stylet/core/survive.hpp"

#include <new>
#include <system_error>

namespace stylet {

std::string Error::message() const {
  std::string text = printable_clause(where, kLongestPlace);
  if (!text.empty() && !what.empty()) text += ": ";
  text += printable_clause(what);
  if (!cure.empty()) {
    if (!text.empty() && text.back() != '.' && text.back() != '?') text += '.';
    text += ' ' + printable_clause(cure);
  }
  return text;
}

Error caught_exception(const std::string& where) {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return failure(where, "there is too little memory", "Close other programs, or use a coarser mesh (mesh.nodes)");
  } catch (const std::system_error& refused) {
    return failure(where, "the system refuses it: " + refused.code().message(), "Close other programs and try again");
  } catch (...) {
    return failure(where, "a fault of the program ended this work",
                   "Try again, and report it with the command line and the input if it comes back");
  }
}

}  // namespace stylet
