#ifndef sabot_base_hash_h
#define sabot_base_hash_h

#include <cstddef>
#include <string>

namespace sabot
{
/** SHA-256 (FIPS 180-4, by OpenSSL) of @p n_bytes bytes as 64 hexadecimal
    digits in lower case. Tells damaged checkpoints and names runs of studies
    by their parameters. */
std::string sha256(const void *data, const std::size_t n_bytes);
inline std::string sha256(const std::string &text)
{
  return sha256(text.data(), text.size());
}

/** Base64 (RFC 4648, with padding and without line ends), by OpenSSL: pictures
    within HTML. */
std::string base64(const std::string &bytes);

/** SHA-256 of the first @p n_bytes of a file, read in pieces; empty when it
    cannot be read or is shorter. */
std::string sha256_of_file(const std::string &file, const std::size_t n_bytes);
} // namespace sabot

#endif
