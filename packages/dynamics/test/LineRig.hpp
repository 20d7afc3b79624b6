#pragma once

#include <coplane_dynamics/Line.hpp>

// A line on hosts whose motion is given.
namespace coplane
{
/// Where the points of the line are at the start, alive and without pressure.
inline LineHosts hostsOf(const LineSetup& setup)
{
  LineHosts hosts;
  for (const LinePoint& point : setup.points)
    hosts.x.push_back(point.place);
  hosts.alive.assign(hosts.x.size(), 1);
  hosts.pressure.assign(hosts.x.size(), 0);
  return hosts;
}

/// Installed without force where the hosts are.
inline Line installed(const LineSetup& setup, const LineHosts& hosts,
                      const std::vector<int>& dowels = {})
{
  Line line(setup, dowels);
  line.advance(hosts, 0, 0, 0);
  return line;
}
} // namespace coplane
