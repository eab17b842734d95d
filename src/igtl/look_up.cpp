// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport.hpp"

#include <fmt/format.h>

namespace stylet::igtl {

using boost::asio::ip::tcp;

Result<Endpoints> look_up(boost::asio::io_context& io, const LinkSettings& settings) {
  boost::system::error_code error;
  tcp::resolver resolver(io);
  const auto flags = settings.role == Role::server ? tcp::resolver::passive : tcp::resolver::flags{};
  const auto found = resolver.resolve(settings.host, std::to_string(settings.port), flags, error);
  Endpoints endpoints;
  if (!error)
    for (const auto& entry : found) endpoints.push_back(entry.endpoint());
  if (endpoints.empty())
    return input_error("OpenIGTLink, host", fmt::format("'{}' is not known", settings.host),
                       "Give a host name or an IP address, such as 127.0.0.1 for this machine");
  return endpoints;
}

}  // namespace stylet::igtl
