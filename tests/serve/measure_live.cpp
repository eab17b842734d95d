// SPDX-License-Identifier: GPL-3.0-or-later
// Measures a running `stylet serve --no-token` as a page sees it; no test, since it tells of the machine as well.
//   measure_live needles PORT PROCESS COUNT      memory of the server after each of COUNT needles of a plan
//   measure_live downloads PORT NAME COUNT       time of a step while the recording NAME is downloaded and while not,
//                                                by turns, COUNT times each
#include "live_client.hpp"

#include <fmt/format.h>

#include <atomic>
#include <fstream>
#include <thread>

using namespace stylet::test;

namespace {

/// [MB] Memory of a process that is in use.
double memory_of(const std::string& process) {
  std::ifstream lines("/proc/" + process + "/status");
  for (std::string word; lines >> word;) {
    double kilobytes = 0.0;
    if (word == "VmRSS:" && lines >> kilobytes) return 1.024e-3 * kilobytes;
  }
  throw std::runtime_error("there is no process " + process);
}

void need(bool holds, const char* else_says) {
  if (!holds) throw std::runtime_error(else_says);
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

void measure_needles(LiveClient& page, const std::string& process, std::size_t count) {
  need(page.take(), "the needle cannot be taken");
  need(page.until([&] { return page.plan.contains("needles"); }), "there is no plan");
  const std::size_t needles = page.plan["needles"].size();
  std::vector<double> memory;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t needle = k % needles;
    if (k > 0) {
      page.command(fmt::format(R"({{"do":"needle","index":{}}})", needle));
      need(page.until([&] { return page.plan["current"] == needle && page.depth_mm < 0.0F; }),
           "the needle is not ready");
    }
    const auto& seeds = page.plan["needles"][needle]["seeds"];
    need(page.go_to(seeds[0]["drop_depth_mm"], 80.0F), "the needle does not reach its first seed");
    if (k < needles) page.command(R"({"do":"drop"})");
    need(page.passes(0.2), "the time does not pass");
    need(page.go_to(-2.0F, 40.0F), "the needle does not come out");
    memory.push_back(memory_of(process));
    fmt::print("needle {:2}: {:.0f} MB\n", k + 1, memory.back());
    std::fflush(stdout);
  }
  fmt::print("after {} needles {:.2f} times the memory after two\n", count, memory.back() / memory[1]);
}

/// [µs] p50 and p99 of the processor time of the steps of a run in which the needle goes in and out.
std::pair<double, double> steps_of_a_run(LiveClient& page) {
  page.command(R"({"do":"reset"})");
  const auto done = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  need(page.until([&] { return std::chrono::steady_clock::now() > done; }) && page.depth_mm < 0.0F, "no new run");
  for (int k = 0; k < 3; ++k) need(page.go_to(60.0F, 20.0F) && page.go_to(0.0F, 40.0F), "the needle does not move");
  need(page.passes(1.0), "the time does not pass");
  return {page.status["loop"]["p50_us"], page.status["loop"]["p99_us"]};
}

void measure_downloads(LiveClient& page, std::uint16_t port, const std::string& name, int count) {
  need(page.take(), "the needle cannot be taken");
  std::vector<double> alone, beside;
  for (int k = 0; k < count; ++k) {
    const auto [p50, p99] = steps_of_a_run(page);
    std::atomic<bool> ends = false, has_ended = false;
    std::atomic<std::size_t> bytes = 0;
    std::thread visitor([&] {
      while (!ends) bytes += get(port, "/recordings/" + name + "/forces.csv").body().size();
      has_ended = true;
    });
    const auto [p50_beside, p99_beside] = steps_of_a_run(page);
    ends = true;
    need(page.until([&] { return has_ended.load(); }), "the download does not end");
    visitor.join();
    fmt::print("p50 {:.0f} and p99 {:.0f} us alone; {:.0f} and {:.0f} us beside a download ({} MB)\n", p50, p99,
               p50_beside, p99_beside, bytes / 1'000'000);
    std::fflush(stdout);
    alone.push_back(p99);
    beside.push_back(p99_beside);
  }
  fmt::print("median of p99: {:.0f} and {:.0f} us, ratio {:.2f}\n", median(alone), median(beside),
             median(beside) / median(alone));
}

}  // namespace

int main(int count, char** words) {
  const std::vector<std::string> what(words + 1, words + count);
  if (what.size() != 4) return 2;
  try {
    const auto port = static_cast<std::uint16_t>(std::stoi(what[1]));
    LiveClient page(port);
    need(page.until([&] { return page.ready(); }), "the server has no case");
    if (what[0] == "needles") measure_needles(page, what[2], std::stoul(what[3]));
    if (what[0] == "downloads") measure_downloads(page, port, what[2], std::stoi(what[3]));
  } catch (const std::exception& failed) {
    fmt::print(stderr, "measure_live: {}\n", failed.what());
    return 1;
  }
  return 0;
}
