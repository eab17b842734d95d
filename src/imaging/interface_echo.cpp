// SPDX-License-Identifier: GPL-3.0-or-later
#include "interface_echo.hpp"

#include <utility>

namespace stylet {

InterfaceEcho interface_echo(TissueRole a, TissueRole b) {
  using enum TissueRole;
  const auto between = [&](TissueRole x, TissueRole y) { return (a == x && b == y) || (a == y && b == x); };
  const auto one_is = [&](TissueRole x) { return a == x || b == x; };
  if (a == b) return {};
  if (one_is(bone)) return {22.0F, 2.5F, 0.5};
  if (one_is(fluid)) return {18.0F, 5.0F};
  if (one_is(lumen)) return {13.0F, 4.0F};
  if (one_is(rectal_wall)) return {12.0F, 5.0F};
  if (one_is(urethra)) return {6.0F, 6.0F};
  if (is_gland(a) && is_gland(b)) return {4.0F, 6.0F};
  if (is_gland(a) || is_gland(b)) return {16.0F, 2.5F};
  if (between(fat, muscle) || between(fat, soft)) return {7.0F, 6.0F};
  return {3.0F, 6.0F};
}

}  // namespace stylet
