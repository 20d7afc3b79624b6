#include <coplane_core/DraftName.hpp>

#include <fmt/format.h>

#include <chrono>
#include <random>
#include <unistd.h>

namespace coplane
{
namespace
{
std::string newToken()
{
  const auto now = std::chrono::system_clock::now().time_since_epoch().count();
  char host[256] = {};
  ::gethostname(host, sizeof host - 1);
  const std::string seed = fmt::format("{} {} {}", host, ::getpid(), now);
  std::seed_seq sequence(seed.begin(), seed.end());
  std::mt19937 generator(sequence);
  return fmt::format("{:08x}", generator());
}

std::string& token()
{
  static std::string token = newToken();
  return token;
}
} // namespace

const std::string& draftToken()
{
  return token();
}

void setDraftToken(const std::string& other)
{
  token() = other;
}

std::string draftOf(const std::string& file)
{
  return file + ".part-" + token();
}
} // namespace coplane
