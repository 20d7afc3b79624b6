#include <coplane_output/Sha256.hpp>

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <vector>

namespace coplane
{
namespace
{
// First 32 bits of the fractional parts of the cube roots of the first 64 primes.
constexpr std::uint32_t roundConstants[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

std::uint32_t rotated(std::uint32_t x, int n)
{
  return (x >> n) | (x << (32 - n));
}

class Digest
{
public:
  void add(const char* data, std::size_t size)
  {
    length_ += size;
    for (std::size_t i = 0; i < size; ++i)
    {
      block_[used_++] = static_cast<unsigned char>(data[i]);
      if (used_ == block_.size())
        compress();
    }
  }

  std::string text()
  {
    const std::uint64_t bits = 8 * length_;
    add("\x80", 1);
    while (used_ != 56)
      add("\0", 1);
    for (int i = 7; i >= 0; --i)
    {
      const char byte = char(bits >> (8 * i));
      add(&byte, 1);
    }
    std::string result;
    for (const std::uint32_t word : hash_)
      result += fmt::format("{:08x}", word);
    return result;
  }

private:
  void compress()
  {
    std::uint32_t w[64];
    for (int i = 0; i < 16; ++i)
      w[i] = std::uint32_t(block_[4 * i]) << 24 | std::uint32_t(block_[4 * i + 1]) << 16 |
             std::uint32_t(block_[4 * i + 2]) << 8 | block_[4 * i + 3];
    for (int i = 16; i < 64; ++i)
      w[i] = w[i - 16] + w[i - 7] +
             (rotated(w[i - 15], 7) ^ rotated(w[i - 15], 18) ^ (w[i - 15] >> 3)) +
             (rotated(w[i - 2], 17) ^ rotated(w[i - 2], 19) ^ (w[i - 2] >> 10));
    auto [a, b, c, d, e, f, g, h] = hash_;
    for (int i = 0; i < 64; ++i)
    {
      const std::uint32_t t1 = h + (rotated(e, 6) ^ rotated(e, 11) ^ rotated(e, 25)) +
                               ((e & f) ^ (~e & g)) + roundConstants[i] + w[i];
      const std::uint32_t t2 =
          (rotated(a, 2) ^ rotated(a, 13) ^ rotated(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
      h = g;
      g = f;
      f = e;
      e = d + t1;
      d = c;
      c = b;
      b = a;
      a = t1 + t2;
    }
    const std::uint32_t sums[8] = {a, b, c, d, e, f, g, h};
    for (int i = 0; i < 8; ++i)
      hash_[i] += sums[i];
    used_ = 0;
  }

  // First 32 bits of the fractional parts of the square roots of the first 8 primes.
  std::array<std::uint32_t, 8> hash_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                     0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> block_{};
  std::size_t used_ = 0;
  std::uint64_t length_ = 0;
};
} // namespace

std::string sha256(const std::string& bytes)
{
  Digest digest;
  digest.add(bytes.data(), bytes.size());
  return digest.text();
}

std::string sha256OfFile(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    return "";
  Digest digest;
  std::vector<char> buffer(1 << 16);
  while (stream)
  {
    stream.read(buffer.data(), std::streamsize(buffer.size()));
    digest.add(buffer.data(), std::size_t(stream.gcount()));
  }
  return digest.text();
}
} // namespace coplane
