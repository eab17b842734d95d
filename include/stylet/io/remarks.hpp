// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

namespace stylet {

/// Sets the receiver of remarks: sentences for the user that belong to no result, such as that a cache is full. Each is
/// given once. Without a receiver nothing is said.
/// @param receiver may be called from any thread; empty: nobody receives remarks any more
void receive_remarks(std::function<void(const std::string&)> receiver);

}  // namespace stylet
