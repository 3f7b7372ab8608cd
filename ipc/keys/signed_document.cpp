// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/keys/signed_document.hpp"

#include "core/errors.hpp"

namespace isobar::keys {

std::string sign_document(std::string_view text, const Identity& authority) {
  // PKCS7_TEXT: with the header of a text, without which Cyclone DDS refuses the document.
  constexpr int kFlags = PKCS7_DETACHED | PKCS7_STREAM | PKCS7_TEXT;
  const BioPointer input = reader_of(text);
  const SignedPointer signature(
      PKCS7_sign(authority.certificate.get(), authority.key.get(), nullptr, input.get(), kFlags));
  require_openssl(signature != nullptr, "signature");
  const BioPointer output = make_buffer();
  require_openssl(SMIME_write_PKCS7(output.get(), signature.get(), input.get(), kFlags) == 1, "S/MIME");
  return content_of(output.get());
}

std::string verified_text(std::string_view document, const X509& authority, const std::string& path,
                          const std::string& authority_path) {
  BIO* raw_content = nullptr;
  const SignedPointer signature(SMIME_read_PKCS7(reader_of(document).get(), &raw_content));
  const BioPointer content(raw_content);
  if (signature == nullptr) {
    throw DataError(path + ": must be a document signed in S/MIME: " + last_openssl_error());
  }
  const StorePointer store(X509_STORE_new());
  require_openssl(store != nullptr && X509_STORE_add_cert(store.get(), const_cast<X509*>(&authority)) == 1,
                  "store");
  // The time is checked with the dates, where the error can state them.
  X509_VERIFY_PARAM_set_flags(X509_STORE_get0_param(store.get()), X509_V_FLAG_NO_CHECK_TIME);
  const BioPointer output = make_buffer();
  if (PKCS7_verify(signature.get(), nullptr, store.get(), content.get(), output.get(), PKCS7_TEXT) != 1) {
    throw DataError(path + ": must be signed by " + authority_path +
                    "; it was changed or comes from another authority: " + last_openssl_error());
  }
  return content_of(output.get());
}

}  // namespace isobar::keys
