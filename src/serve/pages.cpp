// SPDX-License-Identifier: GPL-3.0-or-later
#include "pages.hpp"

#include "assets.hpp"
#include "attachment.hpp"

#include "io/record/json.hpp"
#include "stylet/core/printable.hpp"
#include "stylet/io/run_recorder.hpp"
#include "stylet/sim/recorded_steps.hpp"

#include <algorithm>

namespace stylet::serve {

namespace http = boost::beast::http;

namespace {

HttpResponse response(const HttpRequest& request, http::status status, const char* type, std::string body) {
  HttpResponse r(status, request.version());
  r.set(http::field::content_type, type);
  r.set(http::field::cache_control, "no-store");
  r.set("X-Content-Type-Options", "nosniff");
  r.set("Referrer-Policy", "no-referrer");  // the address may hold the token
  r.keep_alive(request.keep_alive());
  const std::size_t length = body.size();
  if (request.method() != http::verb::head) r.body() = std::move(body);
  r.content_length(length);
  return r;
}

HttpResponse asset(const HttpRequest& request, const char* type, std::string_view text) {
  HttpResponse r = response(request, http::status::ok, type, std::string(text));
  r.set(
      "Content-Security-Policy",
      "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self' ws: wss:; "
      "frame-ancestors 'none'");
  return r;
}

std::string_view header(const HttpRequest& request, http::field field) {
  const auto value = request[field];
  return {value.data(), value.size()};
}

}  // namespace

std::string_view target(const HttpRequest& request) { return {request.target().data(), request.target().size()}; }

Access::Verdict Pages::verdict(const HttpRequest& request) const {
  return access_.check(target(request), header(request, http::field::host), header(request, http::field::origin));
}

HttpResponse Pages::refusal(const HttpRequest& request, http::status status, const std::string& why) {
  return response(request, status, "text/plain; charset=utf-8", printable_lines(why) + "\n");
}

HttpResponse Pages::recordings(const HttpRequest& request) const {
  record::Json list = record::Json::array();
  for (const CatalogueEntry& entry : catalogue_->list()) {
    record::Json row = {{"name", entry.name}};
    if (entry.problem.empty()) {
      row.update({{"case", entry.of_case},
                  {"needle", record::or_null(entry.needle)},
                  {"seconds", entry.duration_s},
                  {"ended", entry.has_ended},
                  {"peak_force_N", record::or_null(entry.most_N)},
                  {"seeds", nullptr}});
      if (entry.has_plan) {
        row["seeds"] = {{"dropped", entry.seeds},
                        {"planned", entry.planned_seeds},
                        {"d90_percent", record::or_null(entry.d90_percent)}};
      }
    } else {
      row["problem"] = entry.problem;
    }
    list.push_back(std::move(row));
  }
  return response(request, http::status::ok, "application/json", record::compact(list));
}

/// The force curve of a recording. @param path NAME/forces.csv
HttpResponse Pages::recording(const HttpRequest& request, std::string_view path) const {
  const auto slash = path.find('/');
  const auto name = percent_decoded(path.substr(0, slash));
  if (slash == std::string_view::npos || path.substr(slash) != "/forces.csv" || !name)
    return refusal(request, http::status::not_found, "There is no such page.");
  const auto run = shelf_.read(*name);
  if (!run) return refusal(request, http::status::not_found, run.error().message());
  HttpResponse r =
      response(request, http::status::ok, "text/csv; charset=utf-8", forces_csv_text(with_ends_of_rests(run->steps)));
  r.set(http::field::content_disposition, attachment(*name + ".csv"));
  return r;
}

HttpResponse Pages::answer(const HttpRequest& request) const {
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return refusal(request, http::status::method_not_allowed, "Only GET and HEAD requests are answered.");
  if (access_.check_open(header(request, http::field::host)) != Access::Verdict::granted)
    return refusal(request, http::status::forbidden, "This server answers to localhost only.");
  const std::string_view path = path_of(target(request));
  if (path == "/" || path == "/index.html") return asset(request, "text/html; charset=utf-8", page());
  if (path == "/live.js") return asset(request, "text/javascript; charset=utf-8", script());
  if (path == "/live.css") return asset(request, "text/css; charset=utf-8", style());
  const Access::Verdict may = verdict(request);
  if (may == Access::Verdict::foreign)
    return refusal(request, http::status::forbidden, "A page of another origin may not use this server.");
  if (may == Access::Verdict::no_token)
    return refusal(request, http::status::unauthorized,
                   "The token is missing or wrong: open the address that stylet serve printed.");
  if (path == "/recordings") return recordings(request);
  constexpr std::string_view kRecordings = "/recordings/";
  if (path.substr(0, kRecordings.size()) == kRecordings) return recording(request, path.substr(kRecordings.size()));
  if (path == "/live")
    return refusal(request, http::status::upgrade_required, "This address is for WebSocket connections only.");
  return refusal(request, http::status::not_found, "There is no such page.");
}

}  // namespace stylet::serve
