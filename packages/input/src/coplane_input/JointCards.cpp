#include "JointCards.hpp"

#include <coplane_joint/JointModel.hpp>

namespace coplane
{
namespace
{
const JointModel& modelOf(const JointCard& card)
{
  return *findModel(jointModels(), card.model);
}
} // namespace

JointCard::JointCard()
    : model(jointModels().front().name), parameters(jointModels().front().parameters())
{
}

JointLaw jointLawOf(const JointCard& card)
{
  return modelOf(card).law(card.parameters.get());
}

bool needsElements(const JointCard& card)
{
  return modelOf(card).needsElements;
}

void checkJoints(const std::vector<JointCard>& joints, const DeckNode& root, Problems& problems)
{
  for (const JointCard& card : joints)
    if (modelOf(card).check)
      modelOf(card).check(card.parameters.get(),
                          {nodeAt(root, {"joints", card.name}), "joints." + card.name, problems});
}
} // namespace coplane
