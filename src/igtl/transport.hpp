// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hub.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

namespace stylet::igtl {

using Endpoints = std::vector<boost::asio::ip::tcp::endpoint>;

/// Resolves the addresses of a host; asks the name service unless the host is an IP address.
Result<Endpoints> look_up(boost::asio::io_context& io, const LinkSettings& settings);

/// Makes the connections. Runs in the link's thread once that has started.
class Transport {
 public:
  virtual ~Transport() = default;
  virtual void start() = 0;
  virtual void stop() = 0;  ///< makes no more connections
};

/// Listens and passes new connections to the hub. The port is open when this function returns.
Result<std::unique_ptr<Transport>> listen(boost::asio::io_context& io, const LinkSettings& settings, Hub& hub);

/// Connects, and connects again when the attempt fails or the connection ends, after pauses that double.
Result<std::unique_ptr<Transport>> dial(boost::asio::io_context& io, const LinkSettings& settings, Hub& hub);

}  // namespace stylet::igtl
