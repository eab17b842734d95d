// SPDX-License-Identifier: GPL-3.0-or-later
// No exception ends the server: one is thrown at each place where a thread begins a piece of work.
#include "small_implant.hpp"

#include "support/thrower.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <mutex>

using namespace stylet;
using namespace stylet::test;

namespace {

/// The text that the server has printed on the terminal.
struct Terminal {
  std::mutex mutex;
  std::string text;
  [[nodiscard]] std::string said() {
    const std::lock_guard lock(mutex);
    return text;
  }
};

std::unique_ptr<Serving> serving_implant(Terminal& terminal) {
  return std::make_unique<Serving>([&](serve::ServerSettings& s) {
    s.session.cases = {implant_case(), box_case("without")};
    s.session.room_every_s = 0.05;
    s.session.say = [&terminal](const std::string& text) {
      const std::lock_guard lock(terminal.mutex);
      terminal.text += text + "\n";
    };
  });
}

/// The answer to a request; empty if the server has closed the connection without one.
std::optional<http::response<http::string_body>> asked(const Serving& serving, const std::string& target) {
  try {
    return get(serving.port(), target);
  } catch (const boost::system::system_error&) {
    return std::nullopt;
  }
}

/// A new page sees the needle, and the page that holds it moves it.
void expect_alive(const Serving& serving, LiveClient& holder) {
  const auto answer = asked(serving, "/recordings");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->result(), http::status::ok);
  const auto newcomer = ready_client(serving);
  ASSERT_TRUE(newcomer->passes(0.05));
  const float depth = holder.depth_mm > 2.0F ? -1.0F : 6.0F;
  ASSERT_TRUE(holder.go_to(depth));
}

constexpr const char* kPlaces[]{"a new connection",
                                "a request to the server",
                                "a message of a page",
                                "a request of a page",
                                "the picture of the needle",
                                "the seeds",
                                "a step of the needle",
                                "the compliance ahead of the needle",
                                "the picture of the tissue's motion",
                                "the folder of recordings",
                                "the map of the holes",
                                "the insertion through a hole",
                                "the session",
                                "the dose of the plan",
                                "the dose of the seeds",
                                "the model of another needle",
                                "the image",
                                "the recording"};

}  // namespace

TEST(Survival, an_exception_in_any_thread_ends_one_piece_of_work_and_nothing_else) {
  Terminal terminal;
  const auto serving = serving_implant(terminal);
  const auto page = ready_client(*serving);
  ASSERT_TRUE(page->take());
  for (const char* place : kPlaces) {
    SCOPED_TRACE(place);
    const Thrower thrower(place);
    // Everything that a page can do, so that every place is reached.
    const auto ask = [&](const char* command) { page->command(command); };
    ask(R"({"do":"case","index":0})");
    ask(R"({"do":"predict","on":1})");
    ask(R"({"do":"image","show":"xray"})");
    ask(R"({"do":"clear"})");
    (void)asked(*serving, "/recordings");
    ASSERT_TRUE(page->until([] { return Thrower::has_thrown(); }));
    ASSERT_TRUE(page->until([&] { return page->status.value("state", "") == "ready"; }));
    ask(R"({"do":"case","index":0})");
    ask(R"({"do":"image","show":"none"})");
    ask(R"({"do":"predict","on":0})");
    const std::uint32_t before = page->scenes;
    ASSERT_TRUE(page->until([&] { return page->scenes > before && page->ready(); }));
    expect_alive(*serving, *page);
    EXPECT_EQ(terminal.said().find("words of a library"), std::string::npos);
    for (const auto& notice : page->notices)
      EXPECT_EQ(notice["text"].get<std::string>().find("words of a library"), std::string::npos);
  }
}

TEST(Survival, a_failed_request_is_answered_in_words) {
  Terminal terminal;
  const auto serving = serving_implant(terminal);
  const auto page = ready_client(*serving);
  ASSERT_TRUE(page->take());
  const Thrower thrower("a request to the server");
  const auto answer = asked(*serving, "/recordings");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->result(), http::status::internal_server_error);
  EXPECT_SAYS(answer->body(), "a fault of the program");
  Thrower::arm("a request of a page");
  page->command(R"({"do":"reset"})");
  EXPECT_SAYS(page->notice(), "a fault of the program");
  Thrower::arm("a message of a page");
  page->command(R"({"do":"resume"})");
  EXPECT_SAYS(page->notice(2), "a fault of the program");
  Thrower::arm("the recording");
  page->hand(30.0F, 5.0F);  // nothing is recorded of a needle that rests
  ASSERT_TRUE(page->until([&] { return !page->status["recording"].value("problem", "").empty(); }));
  EXPECT_SAYS(page->status["recording"]["problem"].get<std::string>(), "a fault of the program");
  EXPECT_SAYS(terminal.said(), "a request of a page: a fault of the program");
  expect_alive(*serving, *page);
}

TEST(Survival, the_first_case_may_fail_and_be_opened_again) {
  for (const char* place : {"the start of the session", "the connections", "the end of the session"}) {
    SCOPED_TRACE(place);
    const Thrower thrower(place);
    Terminal terminal;
    {
      const auto serving = serving_implant(terminal);
      LiveClient page(serving->port());
      ASSERT_TRUE(page.until([&] { return page.status.value("state", "loading") != "loading"; }));
      ASSERT_TRUE(page.take());
      page.command(R"({"do":"case","index":1})");
      ASSERT_TRUE(page.until([&] { return page.ready(); }));
      expect_alive(*serving, page);
    }
    EXPECT_TRUE(Thrower::has_thrown());
    EXPECT_SAYS(terminal.said(), place);
  }
}

TEST(Survival, a_recording_whose_name_is_not_utf8_is_listed) {
  const Serving serving;
  const auto folder = serving.folder.path / "caf\xe9 \x1b[31m";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "run.h5") << "no recording";
  const auto answer = asked(serving, "/recordings");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->result(), http::status::ok);
  std::vector<std::string> names;
  for (const auto& entry : nlohmann::json::parse(answer->body())) names.push_back(entry["name"]);
  EXPECT_NE(std::find(names.begin(), names.end(), "caf\xEF\xBF\xBD  [31m"), names.end());
  const auto refused = asked(serving, "/recordings/caf%e9/forces.csv");
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->result(), http::status::not_found);
  const auto page = ready_client(serving);
  ASSERT_TRUE(page->take());
  EXPECT_TRUE(page->go_to(5.0F));
}
