#include <coplane_core/Error.hpp>
#include <coplane_output/Sha256.hpp>

#include <fmt/ranges.h>
#include <openssl/evp.h>

#include <fstream>
#include <memory>
#include <vector>

namespace coplane
{
namespace
{
/// What OpenSSL computes; its calls fail only when there is no memory.
class Digest
{
public:
  Digest() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free)
  {
    demand(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
  }
  void add(const char* data, std::size_t size)
  {
    demand(EVP_DigestUpdate(context_.get(), data, size));
  }
  std::string text()
  {
    std::vector<unsigned char> bytes(EVP_MAX_MD_SIZE);
    unsigned size = 0;
    demand(EVP_DigestFinal_ex(context_.get(), bytes.data(), &size));
    bytes.resize(size);
    return fmt::format("{:02x}", fmt::join(bytes, ""));
  }

private:
  static void demand(bool isWell)
  {
    if (!isWell)
      fail(ExitCode::Machine, "OpenSSL cannot compute a SHA-256. Is there memory left?");
  }

  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_;
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
