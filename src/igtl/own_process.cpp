// SPDX-License-Identifier: GPL-3.0-or-later
#include "own_process.hpp"

#include <unistd.h>

#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

namespace stylet::igtl {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

template <class Number>
std::optional<Number> from_hex(std::string_view digits) {
  Number value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

/// An endpoint with an address of version 6, so that 127.0.0.1 and ::ffff:127.0.0.1 are the same.
tcp::endpoint in_version_6(const tcp::endpoint& endpoint) {
  const asio::ip::address& address = endpoint.address();
  if (address.is_v4()) return {asio::ip::make_address_v6(asio::ip::v4_mapped, address.to_v4()), endpoint.port()};
  return {asio::ip::address_v6(address.to_v6().to_bytes()), endpoint.port()};  // without its scope
}

/// Decodes "0100007F:1F90": words of the address as they lie in memory, and the port.
std::optional<tcp::endpoint> read_endpoint(std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto port = from_hex<std::uint16_t>(text.substr(colon + 1));
  std::array<std::uint32_t, 4> words{};
  if (!port || (colon != 8 && colon != 32)) return std::nullopt;
  for (std::size_t k = 0; 8 * k < colon; ++k) {
    const auto word = from_hex<std::uint32_t>(text.substr(8 * k, 8));
    if (!word) return std::nullopt;
    words[k] = *word;
  }
  if (colon == 32) {
    asio::ip::address_v6::bytes_type bytes{};
    std::memcpy(bytes.data(), words.data(), bytes.size());
    return tcp::endpoint(asio::ip::address_v6(bytes), *port);
  }
  asio::ip::address_v4::bytes_type bytes{};
  std::memcpy(bytes.data(), words.data(), bytes.size());
  return in_version_6(tcp::endpoint(asio::ip::address_v4(bytes), *port));
}

}  // namespace

std::optional<uid_t> owner_in(std::istream& table, const tcp::endpoint& peer, const tcp::endpoint& here) {
  const tcp::endpoint from = in_version_6(peer);
  const tcp::endpoint to = in_version_6(here);
  std::string line;
  while (std::getline(table, line)) {
    std::istringstream fields(line);
    std::string number, local, remote, state, queues, timer, retransmits;
    uid_t user = 0;
    if (!(fields >> number >> local >> remote >> state >> queues >> timer >> retransmits >> user)) continue;
    if (read_endpoint(local) == from && read_endpoint(remote) == to) return user;
  }
  return std::nullopt;
}

bool is_own_process(const tcp::socket& socket) {
  boost::system::error_code error;
  const tcp::endpoint here = socket.local_endpoint(error);
  if (error) return false;
  const tcp::endpoint peer = socket.remote_endpoint(error);
  if (error) return false;
  for (const char* name : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream table(name);
    if (const auto user = owner_in(table, peer, here)) return *user == ::geteuid();
  }
  return false;
}

}  // namespace stylet::igtl
