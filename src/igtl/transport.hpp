// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hub.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

namespace stylet::igtl {

using Endpoints = std::vector<boost::asio::ip::tcp::endpoint>;

/// Addresses of a host; asks the name service when it is no number.
Result<Endpoints> look_up(boost::asio::io_context& io, const LinkSettings& settings);

/// How connections come about. In the link's thread once that runs.
class Transport {
 public:
  virtual ~Transport() = default;
  virtual void start() = 0;
  virtual void stop() = 0;  ///< no more connections
};

/// Listens; hands what connects to the hub. The port is open when this returns.
Result<std::unique_ptr<Transport>> listen(boost::asio::io_context& io, const LinkSettings& settings, Hub& hub);

/// Connects, and connects again when that fails or ends, after pauses that double.
Result<std::unique_ptr<Transport>> dial(boost::asio::io_context& io, const LinkSettings& settings, Hub& hub);

}  // namespace stylet::igtl
