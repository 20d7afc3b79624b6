#pragma once

#include "Shapes.hpp"

#include <coplane_schema/CardModel.hpp>

#include <functional>
#include <string>
#include <vector>

namespace coplane
{
/// A shape that `parts` may name: its keys, and the bodies that it makes, in the part's own
/// coordinates.
struct ShapeModel : CardModel<std::vector<Body>>
{
  int onlyDimension = 0; ///< in which the shape exists; 0: in both
  std::string otherwise; ///< the shape to take in the other one
  std::function<void(void* parameters, int dimension)> setDimension;
};

/// Every shape, in the order of the manual.
const std::vector<ShapeModel>& shapeModels();

// Each shape is made in the file of its kind.
ShapeModel boxModel();
ShapeModel quadrilateralModel();
ShapeModel hexahedronModel();
ShapeModel wallModel();
ShapeModel imbricateModel();
ShapeModel rockModel();
ShapeModel cylinderModel();
ShapeModel sphereModel();
ShapeModel projectileModel();
ShapeModel ogiveModel();
ShapeModel sectorModel();
ShapeModel domeModel();
ShapeModel crossVaultModel();
ShapeModel halfDiscModel();

/// A shape under construction (CardModelBuilder). makeLaw(const P&) makes the bodies; P has the
/// `int dimension` of the recipe.
template <class P>
class ShapeModelOf : public CardModelBuilder<ShapeModelOf<P>, ShapeModel, P>
{
public:
  ShapeModelOf(const std::string& name, const std::string& meaning)
      : CardModelBuilder<ShapeModelOf<P>, ShapeModel, P>(name, meaning)
  {
    this->model_.setDimension = [](void* parameters, int dimension)
    { static_cast<P*>(parameters)->dimension = dimension; };
  }

  ShapeModelOf& existsIn(int dimension, const std::string& otherwise)
  {
    this->model_.onlyDimension = dimension;
    this->model_.otherwise = otherwise;
    return *this;
  }
};

/// Two or three numbers, one per axis, as a vector; z = 0 in two dimensions.
inline Vec3 toVec3(const std::vector<Real>& x)
{
  return {x[0], x[1], x.size() > 2 ? x[2] : 0.0};
}
/// The same of counts; 1 along z in two dimensions.
inline std::array<int, 3> toCounts(const std::vector<int>& n)
{
  return {n[0], n[1], n.size() > 2 ? n[2] : 1};
}
std::vector<Vec3> toPoints(const std::vector<std::vector<Real>>& points);

/// "key text" unless the count is even.
void demandEven(const CardPlace& place, const std::string& key, int count, const std::string& why);

namespace schema
{
// Keys that several shapes have. P has to have the members.

template <class P>
KeyBuilder divisions(const std::string& meaning)
{
  return integers<P>("divisions", &P::divisions)
      .needed()
      .byDimension()
      .in("elements")
      .atLeast(1)
      .like("[4, 2]")
      .means(meaning);
}

/// A length without a default.
template <class P>
KeyBuilder length(const std::string& name, Real P::*member)
{
  return number<P, Real>(name, member).needed().in("m").above(0);
}

/// A count without a default.
template <class P>
KeyBuilder count(const std::string& name, int P::*member)
{
  return integer<P>(name, member).needed().atLeast(1);
}

template <class P>
Key across()
{
  return count<P>("across", &P::across)
      .in("elements")
      .atLeast(4)
      .like("8")
      .means("elements on the diameter or width; even");
}
} // namespace schema
} // namespace coplane
