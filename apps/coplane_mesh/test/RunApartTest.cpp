#include "RunApart.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <new>
#include <stdexcept>
#include <thread>

namespace coplane
{
namespace
{
using End = ApartOutcome::End;

TEST(WorkApart, bringsItsResultBack)
{
  const std::string large(3000000, 'x');
  int here = 0;
  const ApartOutcome outcome = runApart(
      [&](Stages& stages)
      {
        stages.begin("it worked");
        here = 1; // in the other process
        return large + '\0';
      });
  EXPECT_EQ(outcome.end, End::Done);
  EXPECT_EQ(outcome.bytes, large + '\0');
  EXPECT_EQ(outcome.stage, "it worked");
  EXPECT_EQ(here, 0);
  EXPECT_EQ(runApart([](Stages&) { return std::string(); }).end, End::Done);
}

TEST(WorkApart, bringsItsErrorsBack)
{
  const ApartOutcome deck = runApart([](Stages&) -> std::string { fail(ExitCode::Deck, "no"); });
  EXPECT_EQ(deck.end, End::Failed);
  EXPECT_EQ(deck.code, ExitCode::Deck);
  EXPECT_EQ(deck.bytes, "no");
  const ApartOutcome memory = runApart([](Stages&) -> std::string { throw std::bad_alloc(); });
  EXPECT_EQ(memory.end, End::Failed);
  EXPECT_EQ(memory.code, ExitCode::Machine);
}

TEST(WorkApart, mayCrash)
{
  for (const int signal : {SIGSEGV, SIGABRT, SIGKILL})
  {
    const ApartOutcome outcome = runApart(
        [&](Stages& stages)
        {
          stages.begin("it fell");
          std::signal(signal, SIG_DFL);
          std::raise(signal);
          return std::string("never");
        });
    EXPECT_EQ(outcome.end, End::Died);
    EXPECT_EQ(outcome.signal, signal);
    EXPECT_EQ(outcome.stage, "it fell");
  }
  EXPECT_EQ(runApart([](Stages&) -> std::string { std::_Exit(0); }).end, End::Died);
  EXPECT_EQ(nameOfSignal(SIGSEGV), "segmentation fault (signal 11)");
}

TEST(WorkApart, isEndedWhenAStageTakesTooLong)
{
  const auto begin = std::chrono::steady_clock::now();
  const ApartOutcome outcome = runApart(
      [](Stages& stages)
      {
        stages.begin("it began", 100);
        stages.begin("it hung", 0.3);
        std::this_thread::sleep_for(std::chrono::seconds(100));
        return std::string("never");
      });
  EXPECT_EQ(outcome.end, End::Late);
  EXPECT_EQ(outcome.stage, "it hung");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
}
} // namespace
} // namespace coplane
