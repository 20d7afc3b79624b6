#include <coplane_contact/SearchReach.hpp>
#include <coplane_contact/detail/DeclaredJoints.hpp>

namespace coplane
{
SearchReach::SearchReach(const ContactOptions& options, Real skin, Real smallestFace)
    : leastSkin_(skin), smallestFace_(smallestFace),
      turns_(options.forces == ContactOptions::Forces::Potential)
{
  rules_.cosOpposed = options.cosOpposed;
  rules_.depthMax = turns_ ? std::max(deepestOfPotential, options.depthMax) : options.depthMax;
  rules_.sharedNodes = options.sharedNodes;
  rules_.smallestFace = smallestFace;
  rules_.strays = skin;
  setSkin(skin);
}

void SearchReach::setSkin(Real skin)
{
  rules_.skin = rules_.reach = skin;
  // Nodes move by at most half a skin against each other until the next search, so each face turns
  // by at most a skin over its size. What begins to oppose meanwhile should be known.
  rules_.turning = turns_ ? std::min(mostTurning, 2 * skin / smallestFace_) : 0;
}

void SearchReach::seekJoints(bool seek)
{
  rules_.jointGap = seek ? widestJoint : 0;
}

void SearchReach::begin(Real offset, const Motion& motion)
{
  rules_.offset = offset;
  rules_.reach = rules_.skin + offset;
  rules_.motion = motion;
}

CandidateRules SearchReach::rulesWith(const ContactRules& rules) const
{
  CandidateRules all = rules_;
  all.declared = [&rules](int a, int b) { return rules.between(a, b).declared; };
  all.excluded = [&rules](int a, int b) { return rules.between(a, b).excluded; };
  return all;
}
} // namespace coplane
