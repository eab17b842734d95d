// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <boost/beast/http.hpp>

namespace stylet::serve {

using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;
using HttpResponse = boost::beast::http::response<boost::beast::http::string_body>;

}  // namespace stylet::serve
