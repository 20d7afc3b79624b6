#pragma once

#include <coplane_core/Abort.hpp>
#include <coplane_core/Error.hpp>

#include <exception>

namespace coplane
{
/// Does some work; an error of this rank alone ends all ranks before anything is destroyed that
/// was made outside of it: communicators within libraries are freed by all ranks together, and this
/// one must not wait for others that wait for it.
template <class Work>
void endAllRanksOnOwnError(const Work& work)
{
  try
  {
    work();
  }
  catch (const std::exception& error)
  {
    const auto* ours = dynamic_cast<const Error*>(&error);
    if (!ours || !ours->onAllRanks())
      abortAllRanks(codeOf(error), textOf(error).c_str());
    throw;
  }
}
} // namespace coplane
