#include <coplane_element/ElementKernel.hpp>

namespace coplane
{
void updateQuad4(const ElementKernelData& data)
{
  updateElements<ElementType::Quad4>(data);
}
} // namespace coplane
