#pragma once

namespace coplane
{
/// What signals and observers ask for; decided together by all ranks at the end of a cycle.
struct Requests
{
  bool results = false;    ///< a results step
  bool checkpoint = false; ///< a checkpoint; with `stop`: to go on from later
  bool stop = false;       ///< a last results step and the end

  bool operator==(const Requests& other) const
  {
    return results == other.results && checkpoint == other.checkpoint && stop == other.stop;
  }
};

/// Installs the handlers: SIGUSR1 asks for results and a checkpoint, SIGUSR2 for a checkpoint and
/// the end, SIGINT, SIGTERM, SIGXCPU and, unless it is ignored, SIGHUP for the end.
void listenToSignals();
/// SIGUSR1 and SIGUSR2 wait until listenToRequests(): libraries that begin have handlers of their
/// own, in which requests would be lost.
void holdRequests();
/// The handlers of SIGUSR1 and SIGUSR2 alone: a request that comes early is kept for the first
/// cycle.
void listenToRequests();
/// Asks for something on this rank, as a signal would.
void request(const Requests& wanted);
/// All that was asked for on this rank since the last call.
Requests takeRequests();
} // namespace coplane
