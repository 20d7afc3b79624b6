#include <coplane_dynamics/Signals.hpp>

#include <csignal>
#include <initializer_list>

namespace coplane
{
namespace
{
volatile std::sig_atomic_t resultsRequested = 0;
volatile std::sig_atomic_t checkpointRequested = 0;
volatile std::sig_atomic_t stopRequested = 0;

void onSignal(int signal)
{
  if (signal == SIGUSR1)
    resultsRequested = 1;
  else
    stopRequested = 1;
  if (signal == SIGUSR1 || signal == SIGUSR2)
    checkpointRequested = 1;
}

sigset_t requestSignals()
{
  sigset_t signals;
  ::sigemptyset(&signals);
  ::sigaddset(&signals, SIGUSR1);
  ::sigaddset(&signals, SIGUSR2);
  return signals;
}
} // namespace

void holdRequests()
{
  const sigset_t held = requestSignals();
  ::sigprocmask(SIG_BLOCK, &held, nullptr);
}

void listenToRequests()
{
  for (const int signal : {SIGUSR1, SIGUSR2})
    std::signal(signal, onSignal);
  const sigset_t held = requestSignals();
  ::sigprocmask(SIG_UNBLOCK, &held, nullptr);
}

void listenToSignals()
{
  listenToRequests();
  for (const int signal : {SIGINT, SIGTERM, SIGXCPU})
    std::signal(signal, onSignal);
  struct sigaction before = {};
  ::sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) // as under nohup
    std::signal(SIGHUP, onSignal);
}

void request(const Requests& wanted)
{
  if (wanted.results)
    resultsRequested = 1;
  if (wanted.checkpoint)
    checkpointRequested = 1;
  if (wanted.stop)
    stopRequested = 1;
}

Requests takeRequests()
{
  const Requests requests{resultsRequested != 0, checkpointRequested != 0, stopRequested != 0};
  resultsRequested = checkpointRequested = stopRequested = 0;
  return requests;
}
} // namespace coplane
