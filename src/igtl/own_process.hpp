// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <boost/asio/ip/tcp.hpp>

#include <sys/types.h>

#include <istream>
#include <optional>

namespace stylet::igtl {

/// The user who owns a connection's end at `peer`, from a table as the kernel writes /proc/net/tcp and /proc/net/tcp6;
/// empty if the table does not have it.
/// @param here the other end
std::optional<uid_t> owner_in(std::istream& table, const boost::asio::ip::tcp::endpoint& peer,
                              const boost::asio::ip::tcp::endpoint& here);

/// Whether a process of this user, on this machine, is at the other end of a connection. The kernel knows the owner of
/// a socket on this machine whatever the process says; other machines are strangers.
bool is_own_process(const boost::asio::ip::tcp::socket& socket);

}  // namespace stylet::igtl
