// SHA-256 by OpenSSL, and base64.
#include "sabot/base/hash.h"

#include <openssl/evp.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <vector>

namespace sabot
{
namespace
{
std::string hexadecimal(const unsigned char *digest, const unsigned int length)
{
  const char *const digits = "0123456789abcdef";
  std::string text;
  for (unsigned int i = 0; i < length; ++i)
  {
    text += digits[digest[i] >> 4];
    text += digits[digest[i] & 15];
  }
  return text;
}

const char *const missing = "OpenSSL offers no SHA-256";
} // namespace

std::string sha256(const void *data, const std::size_t n_bytes)
{
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int length = 0;
  if (EVP_Digest(data, n_bytes, digest, &length, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error(missing);
  return hexadecimal(digest, length);
}

std::string base64(const std::string &bytes)
{
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int n = EVP_EncodeBlock(
      reinterpret_cast<unsigned char *>(&text[0]),
      reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size());
  text.resize(n);
  return text;
}

std::string sha256_of_file(const std::string &file, const std::size_t n_bytes)
{
  std::ifstream stream(file, std::ios::binary);
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX *)> context(
      EVP_MD_CTX_new(), EVP_MD_CTX_free);
  if (!context || EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) != 1)
    throw std::runtime_error(missing);
  std::vector<char> buffer(1 << 20);
  for (std::size_t left = n_bytes; left > 0;)
  {
    const std::size_t n = std::min(left, buffer.size());
    if (!stream.read(buffer.data(), n))
      return "";
    EVP_DigestUpdate(context.get(), buffer.data(), n);
    left -= n;
  }
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int length = 0;
  EVP_DigestFinal_ex(context.get(), digest, &length);
  return hexadecimal(digest, length);
}
} // namespace sabot
