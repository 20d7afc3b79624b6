#include <coplane_element/ElementKernel.hpp>

namespace coplane
{
void updateQuad4(const ElementKernelData& data, const Material& law)
{
  updateElements<ElementType::Quad4>(data, law);
}
} // namespace coplane
