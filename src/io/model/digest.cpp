// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/digest.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cstdint>
#include <new>
#include <stdexcept>

namespace stylet::detail {
namespace {

void check(int status) {
  if (status != 1) throw std::runtime_error("SHA-256 is not available");
}

}  // namespace

void Digest::Free::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }

Digest::Digest() : context_(EVP_MD_CTX_new()) {
  if (!context_) throw std::bad_alloc();
  check(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
}
Digest::~Digest() = default;

void Digest::add_bytes(const void* data, std::size_t bytes) {
  const std::uint64_t length = bytes;
  add_plain(&length, sizeof length);
  add_plain(data, bytes);
}

void Digest::add_plain(const void* data, std::size_t bytes) { check(EVP_DigestUpdate(context_.get(), data, bytes)); }

std::string Digest::finish() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned size = 0;
  check(EVP_DigestFinal_ex(context_.get(), bytes.data(), &size));
  std::string text;
  for (unsigned k = 0; k < size; ++k) text += fmt::format("{:02x}", bytes[k]);
  return text;
}

}  // namespace stylet::detail
