#include <coplane_element/ElementKernel.hpp>

namespace coplane
{
void updateTri3(const ElementKernelData& data, const Material& law)
{
  updateElements<ElementType::Tri3>(data, law);
}
} // namespace coplane
