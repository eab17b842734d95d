// SPDX-License-Identifier: GPL-3.0-or-later
// Whose process is at the other end of a connection.
#include "igtl/own_process.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>

#include <sstream>

using namespace stylet::igtl;
using boost::asio::ip::make_address;
using boost::asio::ip::tcp;

namespace {

tcp::endpoint at(const char* address, unsigned short port) { return {make_address(address), port}; }

std::optional<uid_t> owner(const char* table, const tcp::endpoint& peer, const tcp::endpoint& here) {
  std::istringstream lines(table);
  return owner_in(lines, peer, here);
}

}  // namespace

// As a kernel on a little-endian machine writes them.
TEST(OwnProcess, is_found_in_the_tables_of_the_kernel) {
  const char* table =
      "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode\n"
      "   0: 0100007F:4A00 00000000:0000 0A 00000000:00000000 00:00000000 00000000     0        0 1679 1 0 100 0 0\n"
      "   1: 0100007F:4A00 0100007F:C350 01 00000000:00000000 00:00000000 00000000  1000        0 1680 1 0 20 4 30\n"
      "   2: 0100007F:C350 0100007F:4A00 01 00000000:00000000 00:00000000 00000000  1001        0 1681 1 0 20 4 30\n";
  EXPECT_EQ(owner(table, at("127.0.0.1", 50000), at("127.0.0.1", 18944)), 1001u) << "of the peer, not of the server";
  EXPECT_EQ(owner(table, at("127.0.0.1", 18944), at("127.0.0.1", 50000)), 1000u);
  EXPECT_EQ(owner(table, at("::ffff:127.0.0.1", 50000), at("127.0.0.1", 18944)), 1001u);
  EXPECT_FALSE(owner(table, at("127.0.0.1", 50001), at("127.0.0.1", 18944)));
  EXPECT_FALSE(owner(table, at("127.0.0.2", 50000), at("127.0.0.1", 18944)));
  const char* of_version_6 =
      "   0: 00000000000000000000000001000000:C351 00000000000000000000000001000000:4A00 01 0:0 00:0 0  1002        0 "
      "9\n"
      "   1: 0000000000000000FFFF00000100007F:C352 0000000000000000FFFF00000100007F:4A00 01 0:0 00:0 0  1003        0 "
      "9\n";
  EXPECT_EQ(owner(of_version_6, at("::1", 50001), at("::1", 18944)), 1002u);
  EXPECT_EQ(owner(of_version_6, at("127.0.0.1", 50002), at("127.0.0.1", 18944)), 1003u);
  EXPECT_FALSE(owner("nonsense\n 1: 0100007F 0100007F:4A00 01 0 0 0 7\n", at("127.0.0.1", 1), at("127.0.0.1", 18944)));
}

TEST(OwnProcess, is_one_of_this_user_and_none_of_another) {
  boost::asio::io_context io;
  tcp::acceptor acceptor(io, at("127.0.0.1", 0));
  tcp::socket own(io);
  own.connect(acceptor.local_endpoint());
  EXPECT_TRUE(is_own_process(acceptor.accept()));
  if (::geteuid() != 0) return;  // only root can be another user
  const pid_t child = ::fork();
  if (child == 0) {
    if (::seteuid(65534) != 0) _exit(1);
    boost::asio::io_context elsewhere;
    tcp::socket other(elsewhere);
    other.connect(acceptor.local_endpoint());
    char byte = 0;
    boost::system::error_code ended;
    other.read_some(boost::asio::buffer(&byte, 1), ended);
    _exit(0);
  }
  tcp::socket accepted = acceptor.accept();
  EXPECT_FALSE(is_own_process(accepted));
  accepted.close();
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}
