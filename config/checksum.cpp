// SPDX-License-Identifier: BSD-3-Clause
#include "config/checksum.hpp"

#include <openssl/evp.h>

#include <array>

#include "core/errors.hpp"

namespace isobar {

std::string sha256_hex(std::string_view text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw ServiceError("libcrypto has no SHA-256");
  }
  constexpr const char* kHexDigits = "0123456789abcdef";
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) {
    hex += kHexDigits[digest[i] / 16];
    hex += kHexDigits[digest[i] % 16];
  }
  return hex;
}

}  // namespace isobar
