#include <coplane_contact/ClassicLeaders.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
template <int Dim>
ClassicPlane planeOf(const ElementNodes& a, const ElementNodes& b, const ContactOptions& options)
{
  return classicCommonPlane<Dim>(a.blockBefore<Dim>(0), b.blockBefore<Dim>(0),
                                 classicOptions(options));
}

bool pairLess(const Donor& a, const Donor& b)
{
  return elementPairOf(a.faceId) < elementPairOf(b.faceId);
}
} // namespace

ElementNodes elementNodes(const FaceElement& element, const ConstNodeVectors& x,
                          const ConstNodeVectors& v)
{
  ElementNodes nodes;
  nodes.count = element.count;
  for (int k = 0; k < element.count; ++k)
  {
    nodes.x[k] = at(x, element.nodes[k]);
    if (v.extent(0) > 0)
      nodes.v[k] = at(v, element.nodes[k]);
  }
  return nodes;
}

ClassicPlane planeBetween(const FaceElement& a, const FaceElement& b, const ConstNodeVectors& x,
                          int dimension, const ContactOptions& options)
{
  const ElementNodes nodesA = elementNodes(a, x), nodesB = elementNodes(b, x);
  return dimension == 2 ? planeOf<2>(nodesA, nodesB, options) : planeOf<3>(nodesA, nodesB, options);
}

Leader leaderOf(const Face& a, const Face& b, const FaceElement& elementA,
                const FaceElement& elementB, const ConstNodeVectors& x, int dimension,
                const ContactOptions& options)
{
  const ClassicPlane plane = planeBetween(elementA, elementB, x, dimension, options);
  return {plane.face[0] == sideOfFace(a.id) && plane.face[1] == sideOfFace(b.id), plane.normal};
}

DonorRange planesOf(const std::vector<Donor>& planes, const ElementPair& pair)
{
  Donor wanted;
  wanted.faceId[0] = faceId(pair.first, 0);
  wanted.faceId[1] = faceId(pair.second, 0);
  return std::equal_range(planes.begin(), planes.end(), wanted, pairLess);
}

std::vector<Donor> planesOfElements(const std::vector<ElementPair>& wanted,
                                    const std::vector<Donor>& counted, const Comm& comm)
{
  // Planes and questions meet on the rank that the lower element's id names: who asks may know none
  // of the faces of the plane.
  const auto home = [&](const ElementPair& pair)
  { return std::size_t(std::uint64_t(pair.first) % std::uint64_t(comm.size())); };
  std::vector<std::vector<Donor>> planesTo(comm.size());
  for (const Donor& plane : counted)
    planesTo[home(elementPairOf(plane.faceId))].push_back(plane);
  std::vector<Donor> planes = comm.exchange(planesTo);
  std::sort(planes.begin(), planes.end(), pairLess);

  std::vector<std::vector<std::array<GlobalId, 2>>> questionsTo(comm.size());
  for (const ElementPair& pair : wanted)
    questionsTo[home(pair)].push_back({pair.first, pair.second});
  std::vector<int> counts;
  const auto questions = comm.exchange(questionsTo, &counts);
  std::vector<std::vector<Donor>> answersTo(comm.size());
  auto question = questions.begin();
  for (int r = 0; r < comm.size(); ++r)
    for (int i = 0; i < counts[r]; ++i, ++question)
    {
      const ElementPair pair{(*question)[0], (*question)[1]};
      const auto found = planesOf(planes, pair);
      answersTo[r].insert(answersTo[r].end(), found.first, found.second);
    }
  std::vector<Donor> answers = comm.exchange(answersTo);
  std::sort(answers.begin(), answers.end(), pairLess);
  return answers;
}
} // namespace coplane
