#include <coplane_contact/View.hpp>
#include <coplane_contact/WaysOut.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
NodeVectors nodeNormals(const std::vector<Face>& localFaces, const ConstNodeVectors& x,
                        int dimension, const NodeLayout& layout)
{
  NodeVectors normals("coplane::contact::nodeNormals", layout.size());
  for (const Face& face : localFaces)
  {
    const FacePlane plane = facePlane(face, x, dimension);
    for (int k = 0; k < face.count; ++k)
    {
      const int node = face.nodes[k];
      if (node >= layout.owned())
        continue;
      Real angle = 1;
      if (dimension == 3)
      {
        const Vec3 here = at(x, node);
        const Vec3 before = at(x, face.nodes[k == 0 ? face.count - 1 : k - 1]) - here;
        const Vec3 after = at(x, face.nodes[k + 1 == face.count ? 0 : k + 1]) - here;
        angle = std::atan2(norm(cross(after, before)), dot(after, before));
      }
      set(normals, node, at(normals, node) + angle * plane.normal);
    }
  }
  layout.refresh(normals, normals);
  return normals;
}

namespace
{
/// Surfaces that turn by less than this over an edge go on [-]: tangent of half of 20 degrees.
constexpr Real goesOn = 0.17632698;
/// Edges bound a strip if they face away from each other at least so much [-]: minus the cosine.
/// Edges that cross bound none, bodies on them cannot leave each other sideways.
constexpr Real faceAway = 0.5;
/// Beyond an edge a surface still faces the other one if its normal has more than this against it.
constexpr Real stillOpposed = 0.1;
/// Faces lie on each other if their normals have more than this against each other [-]...
constexpr Real nearlyOpposed = 0.94;
/// ... and share more than this fraction of the smaller one.
constexpr Real leastShare = 0.2;
/// Edges run along each other if their outward directions have more than this in common [-].
constexpr Real sameWay = 0.7;
} // namespace

struct EdgesOfSurfaces::Edge
{
  Vec3 outward;              ///< in the face, away from it over the edge
  int nodes[2], count;       ///< one in two dimensions
  Real cosine = 1, sine = 0; ///< of the angle by which the surface turns; the node normals halve it
  bool turns = false;
};

EdgesOfSurfaces::Edge EdgesOfSurfaces::edge(const Face& face, int side, int e,
                                            const Vec3& normal) const
{
  Edge edge;
  if (dimension_ == 2) // the "edge" is node e
  {
    edge.count = 1;
    edge.nodes[0] = edge.nodes[1] = face.nodes[e];
    edge.outward = normalised(at(x_, face.nodes[e]) - at(x_, face.nodes[1 - e]));
  }
  else
  {
    // Edge e of the outline: that of the higher face runs the other way.
    const int next = e + 1 == face.count ? 0 : e + 1;
    edge.count = 2;
    edge.nodes[0] = face.nodes[side == 0 ? e : face.count - 1 - next];
    edge.nodes[1] = face.nodes[side == 0 ? next : face.count - 1 - e];
    edge.outward = normalised(cross(at(x_, edge.nodes[1]) - at(x_, edge.nodes[0]), normal));
  }
  Real half = infinity; // tangent of half of the angle
  for (int i = 0; i < edge.count; ++i)
  {
    const Vec3 atNode = at(normals_, edge.nodes[i]);
    const Real up = dot(atNode, normal), out = dot(atNode, edge.outward);
    half = std::min(half, up > 0 ? out / up : out > 0 ? infinity : 0);
  }
  edge.turns = half > goesOn;
  if (!edge.turns)
    return edge;
  const Real square = half * half;
  edge.cosine = std::isinf(half) ? -1 : (1 - square) / (1 + square);
  edge.sine = std::isinf(half) ? 0 : 2 * half / (1 + square);
  return edge;
}

EdgesOfSurfaces::EdgesOfSurfaces(const std::vector<Face>& localFaces,
                                 const std::vector<CandidatePair>& pairs,
                                 const std::vector<Face>& faces, const ConstNodeVectors& x,
                                 int dimension, const NodeLayout& layout)
    : x_(x), normals_(nodeNormals(localFaces, x, dimension, layout)),
      squares_("coplane::contact::hiddenSquares", layout.size()),
      products_("coplane::contact::hiddenProducts", layout.size()), dimension_(dimension)
{
  findFlushNodes(pairs, faces, layout);
}

Real EdgesOfSurfaces::hiddenAlong(int node, const Vec3& n) const
{
  const Vec3 s = at(squares_, node), p = at(products_, node);
  return n.x * (s.x * n.x + 2 * p.x * n.y) + n.y * (s.y * n.y + 2 * p.y * n.z) +
         n.z * (s.z * n.z + 2 * p.z * n.x);
}

bool EdgesOfSurfaces::lieOn(const Face& a, const Face& b, const FacePlane& planeA,
                            const FacePlane& planeB) const
{
  if (!(dot(planeA.normal, planeB.normal) < -nearlyOpposed))
    return false;
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
  return gap < flush * size && gap > -std::min(a.thickness, b.thickness) &&
         areaAndCentroid(intersection(shadows[0], shadows[1])).area > leastShare * smaller;
}

void EdgesOfSurfaces::findFlushNodes(const std::vector<CandidatePair>& pairs,
                                     const std::vector<Face>& faces, const NodeLayout& layout)
{
  const auto add = [&](int node, const Vec3& n)
  {
    if (node >= layout.owned() || hiddenAlong(node, n) > 0.5)
      return;
    set(squares_, node, at(squares_, node) + Vec3{n.x * n.x, n.y * n.y, n.z * n.z});
    set(products_, node, at(products_, node) + Vec3{n.x * n.y, n.y * n.z, n.z * n.x});
  };
  for (const CandidatePair& pair : pairs)
  {
    const Face* const both[2] = {&faces[pair.lower], &faces[pair.higher]};
    const FacePlane planes[2] = {facePlane(*both[0], x_, dimension_),
                                 facePlane(*both[1], x_, dimension_)};
    if (!lieOn(*both[0], *both[1], planes[0], planes[1]))
      continue;
    for (int e = 0; e < both[0]->count; ++e)
    {
      const Edge mine = edge(*both[0], 0, e, planes[0].normal);
      for (int o = 0; o < both[1]->count && mine.turns; ++o)
      {
        const Edge its = edge(*both[1], 1, o, planes[1].normal);
        if (!its.turns || !(dot(mine.outward, its.outward) > sameWay))
          continue;
        for (int f = 0; f < 2; ++f)
        {
          const Edge& from = f == 0 ? mine : its;
          const Edge& to = f == 0 ? its : mine;
          const Vec3 along = at(x_, to.nodes[1]) - at(x_, to.nodes[0]);
          const Vec3 alongMine = at(x_, from.nodes[1]) - at(x_, from.nodes[0]);
          const Real size =
              dimension_ == 2
                  ? std::min(norm(at(x_, both[0]->nodes[1]) - at(x_, both[0]->nodes[0])),
                             norm(at(x_, both[1]->nodes[1]) - at(x_, both[1]->nodes[0])))
                  : std::sqrt(std::min(dot(along, along), dot(alongMine, alongMine)));
          for (int i = 0; i < from.count; ++i)
          {
            const Vec3 off = at(x_, from.nodes[i]) - at(x_, to.nodes[0]);
            const Real part = dimension_ == 2 ? 0 : dot(off, along) / dot(along, along);
            if (std::abs(dot(off, to.outward)) < flush * size && part > -flush && part < 1 + flush)
              add(from.nodes[i], planes[f].normal);
          }
        }
      }
    }
  }
  layout.refresh(squares_, products_);
}

void EdgesOfSurfaces::look(const Face& a, const Face& b, Plane& plane) const
{
  const FacePlane planes[2] = {facePlane(a, x_, dimension_), facePlane(b, x_, dimension_)};
  const bool onEachOther = lieOn(a, b, planes[0], planes[1]);
  unsigned turns = 0, exits = 0, covered = 0;
  Vec3 outward[8];
  for (int f = 0; f < 2; ++f)
  {
    const Face& face = f == 0 ? a : b;
    const Vec3 &n = planes[f].normal, &other = planes[1 - f].normal;
    for (int e = 0; e < face.count; ++e)
    {
      const Edge edge = this->edge(face, f, e, n);
      if (!edge.turns)
        continue;
      const auto atAllNodes = [&](const Vec3& direction, Real least)
      {
        return hiddenAlong(edge.nodes[0], direction) > least &&
               hiddenAlong(edge.nodes[1], direction) > least;
      };
      const unsigned bit = 1u << (4 * f + e);
      if (!onEachOther && atAllNodes(n, 0.8))
        covered |= bit;
      if (atAllNodes(edge.outward, 0.1)) // goes on over the seam
        continue;
      turns |= bit;
      outward[4 * f + e] = edge.outward;
      if (edge.cosine * dot(n, other) + edge.sine * dot(edge.outward, other) > -stillOpposed)
        exits |= bit;
    }
  }
  plane.turns = std::uint8_t(turns);
  plane.covered = std::uint8_t(covered);
  plane.exits = 0;
  for (int e = 0; e < 4; ++e)
    for (int o = 4; o < 8; ++o)
      if ((exits >> e & exits >> o & 1u) != 0 && dot(outward[e], outward[o]) < -faceAway)
        plane.exits = std::uint8_t(plane.exits | 1u << e | 1u << o);
}
} // namespace coplane
