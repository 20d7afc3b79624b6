# The packages of Coplane, bottom to top. A package may use only packages above its own line: that order is the proof that there
# is no cycle. coplane_package() checks it at configure time, tests/dependencies what sources include; docs/developer/packages.svg
# is drawn from the same files.
set(COPLANE_PACKAGES
  core
  checkpoint
  geometry
  schema
  material
  joint
  mesh
  input
  exodus
  partition
  element
  contact
  dynamics
  setup
  output)
