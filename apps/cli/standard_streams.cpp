// SPDX-License-Identifier: GPL-3.0-or-later
#include "standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <initializer_list>

#include <csignal>

namespace stylet::cli {

bool prepare_standard_streams() {
  const bool output_is_open = ::fcntl(STDOUT_FILENO, F_GETFD) >= 0;
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) < 0)
      (void)::open("/dev/null", O_RDWR);  // gets the lowest free number, which is `stream`
  }
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
  return output_is_open;
}

}  // namespace stylet::cli
