// SPDX-License-Identifier: GPL-3.0-or-later
// The link as a server.
#include "peer.hpp"

#include "stylet/core/printable.hpp"
#include "support/thrower.hpp"

#include <random>

using namespace stylet;
using namespace stylet::igtl;
using namespace stylet::test;
using TissueSurface = stylet::igtl::Surface;

namespace {

Picture picture(double time_s) {
  Picture p;
  p.time_s = time_s;
  p.base.origin = {1, 2, 3};
  p.tip.origin = {10, 20, 30};
  p.tip.rotation = {0.5, 0.5, 0.5, 0.5};
  p.on_hand = {{1, 2, -4}, {10, 20, 30}};
  for (std::size_t k = 0; k < p.shaft.size(); ++k) p.shaft[k] = {0, 0, static_cast<double>(k)};
  return p;
}

/// A grid of n × n points in the plane z.
TissueSurface net(std::uint32_t n, float z) {
  TissueSurface s;
  for (std::uint32_t i = 0; i < n * n; ++i)
    s.points.push_back({static_cast<float>(i / n), static_cast<float>(i % n), z});
  TissueSurface::Triangles triangles;
  for (std::uint32_t i = 0; i + 1 < n; ++i)
    for (std::uint32_t j = 0; j + 1 < n; ++j) {
      const std::uint32_t k = i * n + j;
      triangles.push_back({k, k + n, k + 1});
      triangles.push_back({k + 1, k + n, k + n + 1});
    }
  s.triangles = std::make_shared<const TissueSurface::Triangles>(std::move(triangles));
  return s;
}

Raw text_message(const char* name, const std::string& text) {
  auto message = ::igtl::StringMessage::New();
  message->SetDeviceName(name);
  message->SetString(text.c_str());
  return packed(*message);
}

/// The words of a link about the next message that is not used; empty: nothing within a minute.
Dropped next_news(Link& link) {
  std::vector<Dropped> news;
  comes_true([&] {
    news = link.news();
    return !news.empty();
  });
  return news.empty() ? Dropped{} : news.front();
}

bool reaches(const Link& link, const std::function<bool(const LinkState&)>& condition) {
  return comes_true([&] { return condition(link.state()); });
}

}  // namespace

TEST(Link, everything_that_is_published_arrives_in_ras) {
  const auto link = opened(any_port());
  Peer peer = Peer::to(link->state().port);
  ASSERT_TRUE(link->publish_surface(net(3, 7.0F)).ok());
  const Repeat publisher([&] { link->publish(picture(1.25)); });

  const auto tip = peer.next("TRANSFORM", "NeedleTipToReference");
  ASSERT_TRUE(tip);
  EXPECT_EQ(matrix_of(*tip), (std::array<float, 12>{0, -1, 0, 0, 0, 1, -1, 0, 0, -10, -20, 30}));
  const auto base = peer.next("TRANSFORM", "NeedleBaseToReferenc");
  ASSERT_TRUE(base);
  EXPECT_EQ(matrix_of(*base), (std::array<float, 12>{-1, 0, 0, 0, -1, 0, 0, 0, 1, -1, -2, 3}));
  const auto force = peer.next("NDARRAY", "BaseForce", [](const auto& m) { return wrench_of(m)[0] != 0.0; });
  ASSERT_TRUE(force);
  EXPECT_EQ(wrench_of(*force), (std::array<double, 6>{-1, -2, -4, -10, -20, 30}));
  const auto text = peer.next("STRING", "BaseForce");
  ASSERT_TRUE(text);
  EXPECT_EQ(text_of(*text), R"({"time_s": 1.2500, "force_N": [-1, -2, -4], "torque_Nmm": [-10, -20, 30], )"
                            R"("frame": "RAS", "fresh": true})");
  const auto shaft = peer.next("POINT", "NeedleShaft");
  ASSERT_TRUE(shaft);
  EXPECT_EQ(shaft->body.size(), Picture::kShaft * 136);
  const auto status = peer.next("STATUS", "Stylet", [](const auto& m) { return code_of(m) == 1; });
  EXPECT_TRUE(status);

  ASSERT_TRUE(link->publish_surface(net(4, 7.0F)).ok());
  const auto surface = peer.next("POLYDATA", "TissueSurface", [](const auto& m) { return m.body[3] == 16; });
  EXPECT_TRUE(surface);
}

TEST(Link, a_picture_that_is_no_longer_renewed_has_no_force_and_no_poses) {
  LinkSettings settings = any_port();
  settings.fresh_s = 0.05;
  const auto link = opened(settings);
  Peer peer = Peer::to(link->state().port);
  const auto pressing = [](const auto& m) { return wrench_of(m)[2] == -4.0; };
  {
    const Repeat publisher([&] { link->publish(picture(1.0)); });
    ASSERT_TRUE(peer.next("NDARRAY", "BaseForce", pressing));
  }
  // Messages sent before come first. Then there are only zero forces, and texts with "fresh": false.
  int forces = 0;
  EXPECT_TRUE(comes_true([&] {
    const auto message = peer.next();
    if (!message) return false;
    if (message->type == "TRANSFORM" || message->type == "POINT") forces = 0;
    if (message->type == "STRING" && text_of(*message).find("\"fresh\": false") == std::string::npos) forces = 0;
    if (message->type == "NDARRAY") forces = wrench_of(*message) == std::array<double, 6>{} ? forces + 1 : 0;
    return forces == 30;
  }));
  EXPECT_TRUE(peer.next("STATUS", "Stylet", [](const auto& m) { return code_of(m) == 13; }));
  const Repeat publisher([&] { link->publish(picture(2.0)); });
  EXPECT_TRUE(peer.next("NDARRAY", "BaseForce", pressing));
}

TEST(Link, numbers_that_are_none_are_not_sent) {
  const auto link = opened(any_port());
  Peer peer = Peer::to(link->state().port);
  Picture bad = picture(1.0);
  bad.on_hand.force[1] = std::numeric_limits<double>::quiet_NaN();
  const Repeat publisher([&] { link->publish(bad); });
  for (int k = 0; k < 10; ++k) {
    const auto force = peer.next("NDARRAY", "BaseForce");
    ASSERT_TRUE(force);
    ASSERT_EQ(wrench_of(*force), (std::array<double, 6>{}));
  }
}

TEST(Link, several_others_see_the_same_and_one_that_leaves_disturbs_nobody) {
  const auto link = opened(any_port());
  Peer one = Peer::to(link->state().port);
  Peer two = Peer::to(link->state().port);
  const Repeat publisher([&] { link->publish(picture(1.0)); });
  EXPECT_TRUE(one.next("TRANSFORM", "NeedleTipToReference"));
  EXPECT_TRUE(two.next("TRANSFORM", "NeedleTipToReference"));
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.connections == 2 && s.connected == 2; }));
  one.close();
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.connections == 1; }));
  for (int k = 0; k < 10; ++k) EXPECT_TRUE(two.next("TRANSFORM", "NeedleTipToReference"));
}

TEST(Link, who_connects_later_still_gets_the_surface) {
  const auto link = opened(any_port());
  {
    Peer one = Peer::to(link->state().port);
    ASSERT_TRUE(link->publish_surface(net(4, 7.0F)).ok());
    ASSERT_TRUE(one.next("POLYDATA", "TissueSurface"));
  }
  Peer two = Peer::to(link->state().port);
  EXPECT_TRUE(two.next("POLYDATA", "TissueSurface"));
}

TEST(Link, who_does_not_read_costs_the_others_nothing_and_is_given_up) {
  LinkSettings settings = any_port();
  settings.poses_hz = 200.0;
  settings.surface_hz = 200.0;
  settings.give_up_s = 2.0;
  const auto link = opened(settings);
  Peer deaf = Peer::to(link->state().port);
  Peer reader = Peer::to(link->state().port);
  double time_s = 0.0;
  const auto see = [&] {
    time_s += 1.0;
    link->publish(picture(time_s));
    ASSERT_TRUE(link->publish_surface(net(120, 1.0F)).ok());
    const std::string stamp = "{\"time_s\": " + std::to_string(static_cast<int>(time_s)) + ".0000";
    ASSERT_TRUE(reader.next("STRING", "BaseForce", [&](const auto& m) { return text_of(m).starts_with(stamp); }));
  };
  ASSERT_TRUE(comes_true([&] {
    see();
    return link->state().dropped > 50;
  })) << "what the deaf one does not take is replaced";
  EXPECT_TRUE(comes_true([&] {
    see();
    return link->state().given_up == 1;
  }));
  see();
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.connections == 1; }));
  EXPECT_NE(link->state().problem.find("give_up_s"), std::string::npos);
}

TEST(Link, garbage_ends_its_connection_only) {
  const auto link = opened(any_port());
  Peer good = Peer::to(link->state().port);
  const Repeat publisher([&] { link->publish(picture(1.0)); });
  ASSERT_TRUE(good.next("TRANSFORM", "NeedleTipToReference"));

  Raw endless = library_transform("HandleToReference", at(1, 2, 3));
  endless[42] = 0x80;  // a body of 2⁶³ bytes
  const std::string web = "GET / HTTP/1.1\r\nHost: 127.0.0.1:18944\r\nAccept: everything there is, please\r\n\r\n";
  int count = 0;
  for (const Raw& bytes : {endless, Raw(web.begin(), web.end()), Raw(1000, 0xA5)}) {
    Peer bad = Peer::to(link->state().port);
    bad.send(bytes);
    EXPECT_TRUE(bad.closes());
    ++count;
    EXPECT_TRUE(reaches(*link, [&](const auto& s) { return s.garbage == count && s.connections == 1; }));
  }
  EXPECT_NE(link->state().problem.find("no header of OpenIGTLink"), std::string::npos) << link->state().problem;
  EXPECT_EQ(link->state().not_used, count);
  EXPECT_TRUE(good.next("TRANSFORM", "NeedleTipToReference"));
  EXPECT_EQ(link->state().poses, 0);
}

TEST(Link, a_message_that_never_ends_is_not_waited_for) {
  auto link = opened(any_port());
  const Raw whole = library_transform("HandleToReference", at(1, 2, 3));
  Peer peer = Peer::to(link->state().port);
  peer.send(Raw(whole.begin(), whole.begin() + 80));
  Peer other = Peer::to(link->state().port);
  other.send(whole);
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.poses == 1; }));
  link.reset();
  EXPECT_TRUE(peer.closes());
}

TEST(Link, unknown_messages_pass) {
  const auto link = opened(any_port());
  Peer peer = Peer::to(link->state().port);
  for (int k = 0; k < 10; ++k) peer.send(text_message("Command", "hello"));
  peer.send(library_transform("ToolToReference", at(1, 2, 3)));
  peer.send(library_transform("HandleToReference", at(1, 2, 3)));
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.poses == 1 && s.not_used == 11; }));
  EXPECT_EQ(link->state().garbage, 0);
}

TEST(Link, what_is_not_used_is_told_of_with_its_sender_and_a_cure) {
  const auto link = opened(any_port());
  Peer peer = Peer::to(link->state().port);
  const auto told = [&](const Raw& bytes, const std::string& what, const std::string& cure) {
    peer.send(bytes);
    const Dropped dropped = next_news(*link);
    EXPECT_NE(dropped.what.find(what), std::string::npos) << dropped.what;
    EXPECT_NE(dropped.what.find(" from 127.0.0.1:"), std::string::npos) << dropped.what;
    EXPECT_NE(dropped.cure.find(cure), std::string::npos) << dropped.cure;
    EXPECT_EQ(dropped.count, 1);
  };
  Raw unsealed = library_transform("HandleToReference", at(1, 2, 3));
  put(unsealed, 50, 0, 8);
  told(unsealed, "TRANSFORM 'HandleToReference'", "--igtl-no-checksum");
  Raw newer = library_transform("HandleToReference", at(1, 2, 3));
  put(newer, 0, 3, 2);
  told(newer, "header has version 3", "version 1 or 2");
  told(library_transform("HandleToReference", {}), "no rigid motion", "rotation and translation");
  auto nan = at(1, 2, 3);
  nan[9] = std::numeric_limits<float>::quiet_NaN();
  told(library_transform("StylusToReference", nan), "no pose with this name", "HandleToReference");
  told(text_message("Greeting", "hello"), "no text with this name", "Stylet");
  Raw other = text_message("HandleToReference", "hello");
  std::memcpy(other.data() + 2, "SENSOR", 6);
  told(other, "SENSOR 'HandleToReference'", "TRANSFORM");
  told(text_message("Stylet", std::string(1001, 'x')), "longer than 1000 bytes", "shorter");
  EXPECT_TRUE(peer.next("STRING", "Stylet", [](const auto& m) { return text_of(m).starts_with("refused: "); }));
  peer.send(unsealed);
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.not_used == 8; }));
  EXPECT_TRUE(link->news().empty()) << "the second of a kind is told of later";
  EXPECT_EQ(link->state().poses, 0);
  EXPECT_EQ(link->state().connections, 1) << "none of them ends the connection";
  const Raw whole = library_transform("HandleToReference", at(1, 2, 3));
  peer.send(Raw(whole.begin(), whole.begin() + 80));
  peer.close();
  EXPECT_NE(next_news(*link).what.find("ended inside a message"), std::string::npos);
}

TEST(Link, a_tool_of_tracking_data_moves_the_handle) {
  const auto link = opened(any_port());
  Peer peer = Peer::to(link->state().port);
  peer.send(library_tools("TDATA", at(1, 2, 3)));
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.poses == 1; }));
  peer.send(library_tools("QTDATA", at(1, 2, 3)));
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.poses == 2 && s.not_used == 0; }));
  // The name of a message with one tool counts too.
  Raw only = library_tools("TDATA", at(1, 2, 3));
  only.resize(58 + 70);
  std::memcpy(only.data() + 14, "HandleToReference", 18);
  seal(only);
  peer.send(only);
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.poses == 3; }));
  std::memcpy(only.data() + 14, "SomethingElse", 14);
  peer.send(only);
  const Dropped dropped = next_news(*link);
  EXPECT_NE(dropped.what.find("its tools ('Stylus')"), std::string::npos) << dropped.what;
}

TEST(Link, commands_are_given_and_answered) {
  const auto link = opened(any_port());
  Peer peer = Peer::to(link->state().port);
  const auto given = [&] {
    std::vector<GivenCommand> commands;
    comes_true([&] {
      commands = link->take_commands();
      return !commands.empty();
    });
    return commands.empty() ? GivenCommand{} : commands.front();
  };
  peer.send(text_message("Stylet", "hole\nD4 \xC3"));
  const GivenCommand text = given();
  EXPECT_EQ(text.text, "hole D4 \uFFFD");
  link->answer(text, "");
  EXPECT_TRUE(peer.next("STRING", "Stylet", [](const auto& m) { return text_of(m) == "done: hole D4 \uFFFD"; }));

  peer.send(command("Stylet", 70'001, "reset", ""));
  const GivenCommand named = given();
  EXPECT_EQ(named.text, "reset") << "without a text, the name is the command";
  link->answer(named, "");
  link->answer(named, "it is tired");
  const auto answer = peer.next("RTS_COMMAND", "Stylet");
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->body.size(), 138U + 11U);
  EXPECT_EQ(Raw(answer->body.begin(), answer->body.begin() + 4), (Raw{0, 1, 0x11, 0x71}));
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(answer->body.data()) + 4), "reset");
  EXPECT_EQ(std::string(answer->body.begin() + 138, answer->body.end()), "done: reset");
  const auto second = peer.next("RTS_COMMAND", "Stylet");
  ASSERT_TRUE(second) << "no answer replaces another one";
  EXPECT_EQ(std::string(second->body.begin() + 138, second->body.end()), "refused: it is tired");
  peer.send(text_message("Stylet", "refused: it is tired"));
  EXPECT_NE(next_news(*link).what.find("the answer to a command"), std::string::npos) << "an answer is not answered";

  for (int k = 0; k < 17; ++k) peer.send(text_message("Stylet", "reset"));
  EXPECT_NE(next_news(*link).what.find("too many commands"), std::string::npos);
  EXPECT_EQ(link->take_commands().size(), 16U);
  link->answer({.text = "reset", .connection = 99}, "nobody hears it");
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.connections == 1 && s.not_used == 2; }));
}

TEST(Link, every_damaged_message_is_used_or_counted) {
  const auto link = opened(any_port());
  std::mt19937 random(11);
  const auto number = [&random](std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(random);
  };
  const std::vector<Raw> whole{library_transform("HandleToReference", at(1, 2, 3)),
                               library_transform("StepperToReference", at(1, 2, 3)),
                               library_tools("TDATA", at(1, 2, 3)),
                               library_tools("QTDATA", at(1, 2, 3)),
                               text_message("Stylet", "reset"),
                               command("Stylet", 1, "hole", "hole D4")};
  Peer peer = Peer::to(link->state().port);
  std::int64_t sent = 0;
  std::int64_t commands = 0;
  for (int round = 0; round < 2000; ++round) {
    Raw bytes = whole[number(whole.size())];
    // Every field but the time and the length, which is that of the bytes.
    for (std::size_t k = 0, changes = number(3); k < changes; ++k) {
      const std::size_t where = number(4);
      if (where == 0) bytes[1] = static_cast<std::uint8_t>(1 + number(4));
      if (where == 1) bytes[2] = static_cast<std::uint8_t>('A' + number(26));
      if (where == 2) bytes[14 + number(4)] = static_cast<std::uint8_t>(' ' + number(200));
      if (where == 3) bytes[50 + number(bytes.size() - 50)] = static_cast<std::uint8_t>(number(256));
    }
    if (number(4) == 0) bytes.resize(58 + number(bytes.size() - 57));
    if (number(2) == 0) seal(bytes);
    put(bytes, 42, bytes.size() - 58, 8);
    ASSERT_TRUE(peer.send(bytes));
    ++sent;
    commands += static_cast<std::int64_t>(link->take_commands().size());
  }
  EXPECT_TRUE(reaches(*link,
                      [&](const auto& s) {
                        commands += static_cast<std::int64_t>(link->take_commands().size());
                        return s.poses + s.probe_poses + s.not_used + commands == sent;
                      }))
      << link->state().poses << " + " << link->state().probe_poses << " + " << link->state().not_used << " + "
      << commands << " of " << sent;
  EXPECT_GT(link->state().poses, 100);
  EXPECT_GT(link->state().not_used, 500);
  EXPECT_EQ(link->state().garbage, 0);
  for (const Dropped& dropped : link->news()) {
    EXPECT_EQ(printable(dropped.what), dropped.what);
  }
}

TEST(Link, more_than_the_limit_are_turned_away) {
  LinkSettings settings = any_port();
  settings.max_connections = 1;
  const auto link = opened(settings);
  Peer one = Peer::to(link->state().port);
  ASSERT_TRUE(one.next("STATUS", "Stylet"));
  Peer two = Peer::to(link->state().port);
  EXPECT_TRUE(two.closes());
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.turned_away == 1 && s.connections == 1; }));
  one.close();
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.connections == 0; }));
  Peer three = Peer::to(link->state().port);
  EXPECT_TRUE(three.next("STATUS", "Stylet"));
}

TEST(Link, a_stranger_sees_nothing_and_moves_nothing_before_it_has_given_the_token) {
  LinkSettings settings = any_port();
  settings.trust_own_processes = false;
  const auto link = opened(settings);
  const auto token = [](const char* text) {
    auto message = ::igtl::StringMessage::New();
    message->SetDeviceName("Token");
    message->SetString(text);
    return packed(*message);
  };
  EXPECT_TRUE(Peer::to(link->state().port).closes()) << "there is no token";
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.turned_away == 1 && s.connections == 0; }));
  EXPECT_NE(link->state().problem.find("no token"), std::string::npos) << link->state().problem;

  link->accept_token("the right one");
  Peer silent = Peer::to(link->state().port);
  Peer peer = Peer::to(link->state().port);
  peer.send(library_transform("HandleToReference", at(1, 2, 3)));
  peer.send(token("the wrong one"));
  peer.send(token("the right one"));
  ASSERT_TRUE(peer.next("STATUS", "Stylet"));
  peer.send(library_transform("HandleToReference", at(1, 2, 3)));
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.poses == 1 && s.connections == 1; }));
  EXPECT_TRUE(silent.closes());
  EXPECT_TRUE(reaches(*link, [](const auto& s) { return s.turned_away == 2; }));
  EXPECT_EQ(link->state().poses, 1) << "what came before the token does not count";
  EXPECT_EQ(link->state().connected, 1);
}

TEST(Link, a_port_that_is_taken_is_an_error_that_says_so) {
  const auto link = opened(any_port());
  LinkSettings same;
  same.port = link->state().port;
  const auto second = Link::open(same);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().where.find(std::to_string(same.port)), std::string::npos);
  EXPECT_NE(second.error().what.find("another program uses this port"), std::string::npos);
}

TEST(Link, a_port_can_be_opened_again_at_once) {
  auto link = opened(any_port());
  LinkSettings same;
  same.port = link->state().port;
  Peer peer = Peer::to(same.port);
  ASSERT_TRUE(peer.next("STATUS", "Stylet"));
  link.reset();
  EXPECT_TRUE(peer.closes());
  link = opened(same);
  Peer again = Peer::to(same.port);
  EXPECT_TRUE(again.next("STATUS", "Stylet"));
}

TEST(Link, settings_out_of_range_are_refused) {
  const auto refused = [](const std::function<void(LinkSettings&)>& change, const std::string& word) {
    LinkSettings s = any_port();
    change(s);
    const auto link = Link::open(s);
    ASSERT_FALSE(link) << word;
    EXPECT_NE(link.error().message().find(word), std::string::npos) << link.error().message();
    EXPECT_FALSE(link.error().cure.empty());
  };
  refused([](auto& s) { s.port = -1; }, "port");
  refused([](auto& s) { s.port = 65536; }, "port");
  refused([](auto& s) { s.role = Role::client; }, "port");
  refused([](auto& s) { s.host = ""; }, "host");
  refused([](auto& s) { s.host = "192.0.2.1"; }, "192.0.2.1");  // an address that no machine has
  refused([](auto& s) { s.host = ".."; }, "'..' is not known");
  refused([](auto& s) { s.poses_hz = 0.0; }, "poses_hz");
  refused([](auto& s) { s.poses_hz = std::numeric_limits<double>::quiet_NaN(); }, "poses_hz");
  refused([](auto& s) { s.surface_hz = 100.0; }, "surface_hz");
  refused([](auto& s) { s.images_hz = 100.0; }, "images_hz");
  refused([](auto& s) { s.probe_input = s.probe; }, "twice");
  refused([](auto& s) { s.image = ""; }, "image");
  refused([](auto& s) { s.fresh_s = 0.0; }, "fresh_s");
  refused([](auto& s) { s.max_connections = 0; }, "max_connections");
  refused([](auto& s) { s.give_up_s = 0.0; }, "give_up_s");
  refused([](auto& s) { s.retry_s = 0.0; }, "retry_s");
  refused([](auto& s) { s.longest_retry_s = 0.1; }, "longest_retry_s");
  refused([](auto& s) { s.input = ""; }, "input");
  refused([](auto& s) { s.input = "with a space"; }, "input");
  refused([](auto& s) { s.input = s.tip; }, "twice");
  refused([](auto& s) { s.input = "NeedleBaseToReferencX"; }, "twice");  // the same twenty bytes
}

TEST(Link, surfaces_that_are_none_are_refused) {
  const auto link = opened(any_port());
  TissueSurface s = net(3, 0.0F);
  s.points.pop_back();
  const auto missing = link->publish_surface(std::move(s));
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().what.find("the corner 8, but there are 8 points"), std::string::npos)
      << missing.error().message();
  TissueSurface large;
  large.points.resize(6'000'000);
  EXPECT_FALSE(link->publish_surface(std::move(large)));
  EXPECT_TRUE(link->publish_surface({}).ok()) << "an empty one shows that there is none any more";
}

TEST(Link, an_exception_ends_one_message_and_the_link_goes_on) {
  for (const char* place :
       {"OpenIGTLink", "sending by OpenIGTLink", "a new OpenIGTLink connection", "an OpenIGTLink message"}) {
    SCOPED_TRACE(place);
    const Thrower thrower(place);
    const auto link = opened(any_port());
    const Repeat publisher([&] { link->publish(picture(1.25)); });
    {
      Peer first = Peer::to(link->state().port);
      first.send(Raw(58, 0));  // a header of nothing
      (void)comes_true([] { return Thrower::has_thrown(); });
    }
    EXPECT_TRUE(Thrower::has_thrown());
    Peer second = Peer::to(link->state().port);
    EXPECT_TRUE(second.next("TRANSFORM", "NeedleTipToReference"));
  }
}
