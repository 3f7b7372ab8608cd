// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/keys/openssl.hpp"

#include <openssl/err.h>

#include <climits>
#include <cstdint>
#include <ctime>

#include "core/errors.hpp"

namespace isobar::keys {

std::string last_openssl_error() {
  const unsigned long code = ERR_peek_last_error();
  const char* reason = code != 0 ? ERR_reason_error_string(code) : nullptr;
  std::string text = reason != nullptr ? reason : "unknown error of OpenSSL";
  ERR_clear_error();
  return text;
}

void require_openssl(bool succeeded, const char* what) {
  if (!succeeded) throw ServiceError(std::string(what) + ": " + last_openssl_error());
}

BioPointer reader_of(std::string_view text) {
  BioPointer bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
  require_openssl(bio != nullptr, "memory buffer");
  return bio;
}

BioPointer make_buffer() {
  BioPointer bio(BIO_new(BIO_s_mem()));
  require_openssl(bio != nullptr, "memory buffer");
  return bio;
}

std::string content_of(BIO* buffer) {
  char* data = nullptr;
  const long bytes = BIO_get_mem_data(buffer, &data);
  return bytes > 0 ? std::string(data, static_cast<std::size_t>(bytes)) : std::string();
}

std::int64_t unix_seconds(const ASN1_TIME* time) {
  std::tm parts{};
  if (ASN1_TIME_to_tm(time, &parts) != 1) return INT64_MAX;
  return ::timegm(&parts);
}

}  // namespace isobar::keys
