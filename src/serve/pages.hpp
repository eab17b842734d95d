// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "access.hpp"
#include "catalogue.hpp"
#include "http.hpp"
#include "shelf.hpp"

#include <memory>

namespace stylet::serve {

/// Target and headers of a request.
std::string_view target(const HttpRequest& request);

/// Answers HTTP requests: the page and the recordings. The live connection is a WebSocket and handled elsewhere.
class Pages {
 public:
  Pages(const Access& access, Shelf shelf)
      : access_(access), shelf_(std::move(shelf)), catalogue_(std::make_unique<Catalogue>(shelf_)) {}

  [[nodiscard]] HttpResponse answer(const HttpRequest& request) const;
  [[nodiscard]] Access::Verdict verdict(const HttpRequest& request) const;
  [[nodiscard]] static HttpResponse refusal(const HttpRequest& request, boost::beast::http::status status,
                                            const std::string& why);

 private:
  [[nodiscard]] HttpResponse recordings(const HttpRequest& request) const;
  [[nodiscard]] HttpResponse recording(const HttpRequest& request, std::string_view path) const;

  const Access& access_;
  Shelf shelf_;
  std::unique_ptr<Catalogue> catalogue_;
};

}  // namespace stylet::serve
