#include <coplane_dynamics/Signals.hpp>

#include <csignal>
#include <initializer_list>

namespace coplane
{
namespace
{
volatile std::sig_atomic_t writeRequested = 0;
volatile std::sig_atomic_t stopRequested = 0;

void onSignal(int signal)
{
  if (signal == SIGUSR1)
    writeRequested = 1;
  else
    stopRequested = 1;
}
} // namespace

void listenToSignals()
{
  for (const int signal : {SIGUSR1, SIGUSR2, SIGINT, SIGTERM})
    std::signal(signal, onSignal);
}

Request takeRequest()
{
  const Request request = stopRequested    ? Request::Stop
                          : writeRequested ? Request::WriteResults
                                           : Request::None;
  writeRequested = 0;
  stopRequested = 0;
  return request;
}
} // namespace coplane
