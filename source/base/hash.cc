#include "sabot/base/hash.h"

#include <openssl/evp.h>

#include <stdexcept>

namespace sabot
{
std::string sha256(const void *data, const std::size_t n_bytes)
{
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int length = 0;
  if (EVP_Digest(data, n_bytes, digest, &length, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("OpenSSL offers no SHA-256");
  const char *const digits = "0123456789abcdef";
  std::string text;
  for (unsigned int i = 0; i < length; ++i)
  {
    text += digits[digest[i] >> 4];
    text += digits[digest[i] & 15];
  }
  return text;
}
} // namespace sabot
