#include <coplane_element/ElementKernel.hpp>

namespace coplane
{
void updateHex8(const ElementKernelData& data)
{
  updateElements<ElementType::Hex8>(data);
}
} // namespace coplane
