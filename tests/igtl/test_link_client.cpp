// SPDX-License-Identifier: GPL-3.0-or-later
// The link as a client of the library's server, and of another link.
#include "peer.hpp"

using namespace stylet;
using namespace stylet::igtl;
using namespace stylet::test;

namespace {

LinkSettings client_of(int port) {
  LinkSettings s;
  s.role = Role::client;
  s.port = port;
  s.retry_s = 0.01;
  s.longest_retry_s = 0.1;
  return s;
}

::igtl::ServerSocket::Pointer server() {
  auto socket = ::igtl::ServerSocket::New();
  if (socket->CreateServer(0) != 0) throw std::runtime_error("no server");
  return socket;
}

Picture pressing() {
  Picture p;
  p.on_hand.force = {0, 0, -4};
  return p;
}

}  // namespace

TEST(LinkClient, sends_and_receives_over_a_connection_it_makes) {
  const auto socket = server();
  const auto link = opened(client_of(socket->GetServerPort()));
  Peer peer(socket->WaitForConnection(60'000));
  const Repeat publisher([&] { link->publish(pressing()); });
  EXPECT_TRUE(peer.next("TRANSFORM", "NeedleTipToReference"));
  EXPECT_TRUE(peer.next("NDARRAY", "BaseForce", [](const auto& m) { return wrench_of(m)[2] == -4.0; }));
  peer.send(library_transform("HandleToReference", at(1, 2, 3)));
  EXPECT_TRUE(comes_true([&] { return link->state().poses == 1 && link->state().tracked; }));
}

TEST(LinkClient, connects_again_when_the_connection_ends) {
  const auto socket = server();
  const auto link = opened(client_of(socket->GetServerPort()));
  const auto device = link->device();
  double now_s = 0.0;
  const auto valid = [&] { return device->read({.now_s = now_s += 0.001}).valid; };
  for (int round = 1; round <= 3; ++round) {
    Peer peer(socket->WaitForConnection(60'000));
    {
      const Repeat hand([&] { peer.send(library_transform("HandleToReference", at(1, 2, 3))); });
      EXPECT_TRUE(comes_true(valid)) << round;
    }
    peer.close();
    EXPECT_TRUE(comes_true([&] { return !valid(); })) << round;
  }
  EXPECT_TRUE(comes_true([&] { return link->state().connected >= 3; }));
}

TEST(LinkClient, goes_on_trying_until_the_server_is_there) {
  int port = 0;
  { port = opened(any_port())->state().port; }
  const auto client = opened(client_of(port));
  EXPECT_TRUE(comes_true([&] { return client->state().problem.starts_with("connecting"); }));
  EXPECT_EQ(client->state().connections, 0);
  LinkSettings settings = any_port();
  settings.port = port;
  const auto late = opened(settings);
  EXPECT_TRUE(comes_true([&] { return client->state().connections == 1 && late->state().connections == 1; }));
}

TEST(LinkClient, garbage_ends_the_connection_and_the_next_one_is_tried) {
  const auto socket = server();
  const auto link = opened(client_of(socket->GetServerPort()));
  {
    Peer peer(socket->WaitForConnection(60'000));
    peer.send(Raw(200, 0x5A));
    EXPECT_TRUE(peer.closes());
  }
  Peer peer(socket->WaitForConnection(60'000));
  EXPECT_TRUE(peer.next("STATUS", "Stylet"));
  EXPECT_TRUE(comes_true([&] { return link->state().garbage == 1; }));
}

TEST(LinkClient, ends_while_it_tries) {
  for (int k = 0; k < 20; ++k) {
    LinkSettings s = client_of(1);  // a port at which no program listens
    const auto link = opened(s);
    const auto device = link->device();
    EXPECT_FALSE(device->read({.now_s = 1.0}).valid);
  }
}
