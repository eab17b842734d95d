// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary.hpp"
#include "stylet/core/version.hpp"

#include <algorithm>
#include <cstring>

namespace stylet::rt {

void ErrorText::say(std::string_view message) noexcept {
  if (text_ == nullptr) return;
  std::size_t length = std::min(message.size(), size_ - 1);
  const auto continues = [&](std::size_t k) { return (static_cast<unsigned char>(message[k]) & 0xC0u) == 0x80u; };
  if (length < message.size()) {
    while (length > 0 && continues(length)) --length;
  }
  if (length > 0) std::memcpy(text_, message.data(), length);
  text_[length] = '\0';
}

}  // namespace stylet::rt

extern "C" {

uint32_t stylet_rt_abi_version(void) noexcept { return STYLET_RT_ABI_VERSION; }

const char* stylet_rt_version(void) noexcept { return stylet::version(); }

const char* stylet_rt_status_text(stylet_rt_status status) noexcept {
  switch (status) {
    case STYLET_RT_OK:
      return "ok";
    case STYLET_RT_FAILED:
      return "failed";
    case STYLET_RT_INPUT_ERROR:
      return "wrong input";
    case STYLET_RT_BAD_ARGUMENT:
      return "bad argument";
    case STYLET_RT_OUT_OF_MEMORY:
      return "out of memory";
    default:
      return "unknown status";
  }
}

}  // extern "C"
