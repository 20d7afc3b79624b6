#include <coplane_contact/EdgesOfSurfaces.hpp>
#include <coplane_contact/View.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
/// Edges bound a strip if on the common plane they face away from each other at least so much [-],
/// minus the cosine, and in space have at least so much of their directions in common. Edges that
/// cross bound none: bodies on them cannot leave each other sideways.
constexpr Real faceAway = 0.5, parallel = 0.97;
/// Bodies can leave each other over an edge at which the normal beyond has less than this in common
/// with the face's.
constexpr Real sharp = 0.4;
/// Faces lie on each other if they share more than this fraction of the smaller one.
constexpr Real leastShare = 0.2;
/// A surface turns outwards at an edge if its normal beyond has more than this in the outward
/// direction; reentrant edges do not count.
constexpr Real convex = 0.1;
/// Edges run along each other if their outward directions have more than this in common [-].
constexpr Real sameWay = 0.7;
} // namespace

struct EdgesOfSurfaces::Edge
{
  Vec3 outward; ///< in the face, away from it over the edge
  int nodes[2]; ///< in two dimensions twice the same
  bool turns = false;
  Vec3 beyond; ///< normal of the surface beyond an edge at which it turns
};

EdgesOfSurfaces::Edge EdgesOfSurfaces::edge(const Face& face, int side, int e,
                                            const Vec3& normal) const
{
  Edge edge;
  if (dimension_ == 2) // the "edge" is node e
  {
    edge.nodes[0] = edge.nodes[1] = face.nodes[e];
    edge.outward = normalised(at(x_, face.nodes[e]) - at(x_, face.nodes[1 - e]));
  }
  else
  {
    // Edge e of the outline: that of the higher face runs the other way.
    const int next = e + 1 == face.count ? 0 : e + 1;
    edge.nodes[0] = face.nodes[side == 0 ? e : face.count - 1 - next];
    edge.nodes[1] = face.nodes[side == 0 ? next : face.count - 1 - e];
    edge.outward = normalised(cross(at(x_, edge.nodes[1]) - at(x_, edge.nodes[0]), normal));
  }
  // The surface beyond is the one that both nodes have beside this one, the sharpest turn if there
  // are two.
  Real least = DirectionsOfNodes::one;
  for (int i = 0; i < DirectionsOfNodes::most; ++i)
  {
    const Vec3 other = normals_.direction(edge.nodes[0], i);
    if (dot(other, edge.outward) > convex && dot(other, normal) < least &&
        normals_.find(edge.nodes[1], other) >= 0)
    {
      edge.turns = true;
      edge.beyond = other;
      least = dot(other, normal);
    }
  }
  return edge;
}

EdgesOfSurfaces::EdgesOfSurfaces(const std::vector<Face>& localFaces,
                                 const std::vector<CandidatePair>& pairs,
                                 const std::vector<Face>& faces, const ConstNodeVectors& x,
                                 int dimension, const NodeLayout& layout)
    : x_(x), dimension_(dimension), normals_(layout.size()), hidden_(layout.size()),
      flush_(layout.size())
{
  for (const Face& face : localFaces)
    for (int k = 0; k < face.count; ++k)
      if (face.nodes[k] < layout.owned())
        normals_.add(face.nodes[k], facePlane(face, x, dimension).normal, 0);
  normals_.refresh(layout);
  findHidden(pairs, faces, layout);
}

int EdgesOfSurfaces::hides(const int (&nodes)[2], const Vec3& normal, const Vec3& beyond) const
{
  const Vec3 outward = normalised(beyond - dot(beyond, normal) * normal);
  int bodies[2];
  for (int end = 0; end < 2; ++end)
  {
    const int place = hidden_.find(nodes[end], normal);
    if (place < 0 || flush_.find(nodes[end], outward) < 0)
      return -1;
    bodies[end] = hidden_.number(nodes[end], place);
  }
  return bodies[0] == bodies[1] ? bodies[0] : -1; // two may have a gap between them
}

Real EdgesOfSurfaces::lieOn(const Face& a, const Face& b, const FacePlane& planeA,
                            const FacePlane& planeB) const
{
  if (!(dot(planeA.normal, planeB.normal) < -DirectionsOfNodes::one))
    return 0;
  const Vec3 normal = normalised(planeA.normal - planeB.normal);
  const View view(normal, at(x_, a.nodes[0]), dimension_);
  ConvexPolygon shadows[2];
  Vec3 centers[2];
  for (int f = 0; f < 2; ++f)
  {
    const Face& face = f == 0 ? a : b;
    Vec3 corners[4];
    for (int k = 0; k < face.count; ++k)
    {
      corners[k] = at(x_, face.nodes[k]);
      centers[f] += (1.0 / face.count) * corners[k];
    }
    shadows[f] = view.shadow(corners, face.count);
  }
  const Real smaller = std::min(areaAndCentroid(shadows[0]).area, areaAndCentroid(shadows[1]).area);
  const Real size = dimension_ == 2 ? smaller : std::sqrt(smaller);
  const Real gap = dot(normal, centers[1] - centers[0]);
  const bool near =
      gap < flush * size && gap > -std::min(a.thickness, b.thickness) &&
      areaAndCentroid(intersection(shadows[0], shadows[1])).area > leastShare * smaller;
  return near ? size : 0;
}

void EdgesOfSurfaces::findHidden(const std::vector<CandidatePair>& pairs,
                                 const std::vector<Face>& faces, const NodeLayout& layout)
{
  for (const CandidatePair& pair : pairs)
  {
    const Face* const both[2] = {&faces[pair.lower], &faces[pair.higher]};
    const FacePlane planes[2] = {facePlane(*both[0], x_, dimension_),
                                 facePlane(*both[1], x_, dimension_)};
    const Real size = lieOn(*both[0], *both[1], planes[0], planes[1]);
    if (!(size > 0))
      continue;
    Edge theirs[4];
    for (int o = 0; o < both[1]->count; ++o)
      theirs[o] = edge(*both[1], 1, o, planes[1].normal);
    for (int e = 0; e < both[0]->count; ++e)
    {
      const Edge mine = edge(*both[0], 0, e, planes[0].normal);
      for (int o = 0; o < both[1]->count && mine.turns; ++o)
      {
        const Edge& its = theirs[o];
        if (!its.turns || !(dot(mine.outward, its.outward) > sameWay))
          continue;
        for (int f = 0; f < 2; ++f)
        {
          const Edge& from = f == 0 ? mine : its;
          const Edge& to = f == 0 ? its : mine;
          const Vec3 along = at(x_, to.nodes[1]) - at(x_, to.nodes[0]);
          for (const int node : {from.nodes[0], from.nodes[1]})
          {
            const Vec3 off = at(x_, node) - at(x_, to.nodes[0]);
            const Real part = dimension_ == 2 ? 0 : dot(off, along) / dot(along, along);
            if (node >= layout.owned() || !(std::abs(dot(off, to.outward)) < flush * size) ||
                !(part > -flush && part < 1 + flush))
              continue;
            hidden_.add(node, planes[f].normal, both[1 - f]->body);
            flush_.add(node, from.outward, 0);
          }
        }
      }
    }
  }
  hidden_.refresh(layout);
  flush_.refresh(layout);
}

void EdgesOfSurfaces::look(const Face& a, const Face& b, Plane& plane) const
{
  const FacePlane planes[2] = {facePlane(a, x_, dimension_), facePlane(b, x_, dimension_)};
  const Vec3 common = normalised(planes[0].normal - planes[1].normal);
  const bool onEachOther = lieOn(a, b, planes[0], planes[1]) > 0;
  unsigned turns = 0, exits = 0, covered = 0;
  Vec3 outward[8], along[8];
  for (int f = 0; f < 2; ++f)
  {
    const Face& face = f == 0 ? a : b;
    const Face& other = f == 0 ? b : a;
    for (int e = 0; e < face.count; ++e)
    {
      const Edge edge = this->edge(face, f, e, planes[f].normal);
      if (!edge.turns)
        continue;
      const unsigned bit = 1u << (4 * f + e);
      // Not by the body of the other face: that one comes with what lies there.
      const int third = onEachOther ? -1 : hides(edge.nodes, planes[f].normal, edge.beyond);
      if (third >= 0 && third != other.body)
        covered |= bit;
      if (hides(edge.nodes, edge.beyond, planes[f].normal) >= 0) // goes on over the seam
        continue;
      turns |= bit;
      outward[4 * f + e] = normalised(edge.outward - dot(edge.outward, common) * common);
      along[4 * f + e] = cross(edge.outward, planes[f].normal);
      if (dot(edge.beyond, planes[f].normal) < sharp)
        exits |= bit;
    }
  }
  plane.turns = std::uint8_t(turns);
  plane.covered = std::uint8_t(covered);
  plane.exits = 0;
  for (int e = 0; e < 4; ++e)
    for (int o = 4; o < 8; ++o)
      if ((exits >> e & exits >> o & 1u) != 0 && dot(outward[e], outward[o]) < -faceAway &&
          (dimension_ == 2 || std::abs(dot(along[e], along[o])) > parallel))
        plane.exits = std::uint8_t(plane.exits | 1u << e | 1u << o);
}
} // namespace coplane
