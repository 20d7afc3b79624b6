#pragma once

#include <coplane_contact/PairDistances.hpp>
#include <coplane_contact/PlaneTable.hpp>
#include <coplane_contact/Preparation.hpp>
#include <coplane_contact/detail/PassedOn.hpp>
#include <coplane_contact/detail/PotentialKernel.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/Prefetch.hpp>

#include <algorithm>
#include <atomic>

// Steps A to H for several faces and pairs side by side. A face or a pair gets the bits of the
// scalar functions, whichever others share its lanes.

namespace coplane
{
/// Faces with the same number of nodes side by side; without motion only what steps B and C need
/// for the outlines.
template <bool WithMotion>
inline void putSideBySide(const HalfStepFace* const (&faces)[laneCount],
                          HalfStepFaceOf<Lanes>& face)
{
  const auto each = [&](const auto& get)
  { return branchFree::gathered<Lanes>([&](int i) { return get(*faces[i]); }); };
  const auto vector = [&](const auto& get) -> Vec3Of<Lanes>
  {
    return {each([&](const HalfStepFace& f) { return get(f).x; }),
            each([&](const HalfStepFace& f) { return get(f).y; }),
            each([&](const HalfStepFace& f) { return get(f).z; })};
  };
  face.count = faces[0]->count;
  face.center = vector([](const HalfStepFace& f) { return f.center; });
  face.normal = vector([](const HalfStepFace& f) { return f.normal; });
  face.area = each([](const HalfStepFace& f) { return f.area; });
  for (int k = 0; k < face.count; ++k)
    face.x[k] = vector([&](const HalfStepFace& f) { return f.x[k]; });
  if constexpr (WithMotion)
  {
    for (int k = 0; k < face.count; ++k)
      face.v[k] = vector([&](const HalfStepFace& f) { return f.v[k]; });
    face.spin = vector([](const HalfStepFace& f) { return f.spin; });
    face.massPerArea = each([](const HalfStepFace& f) { return f.massPerArea; });
  }
}

/// Step A for laneCount faces with the same number of nodes.
inline void stepA_faces(const FaceNodesOf<Lanes>& nodes, ContactOptions::Forces forces, Real dt,
                        HalfStepFace* const (&faces)[laneCount])
{
  const HalfStepFaceOf<Lanes> all = forces == ContactOptions::Forces::Potential
                                        ? stepA_faceAtEnd<3>(nodes)
                                        : stepA_halfStepFace<3>(nodes, dt);
  for (int i = 0; i < laneCount; ++i)
  {
    using branchFree::lane;
    HalfStepFace& face = *new (faces[i]) HalfStepFace;
    face.count = all.count;
    for (int k = 0; k < all.count; ++k)
    {
      face.x[k] = lane(all.x[k], i);
      face.v[k] = lane(all.v[k], i);
    }
    face.center = lane(all.center, i);
    face.normal = lane(all.normal, i);
    face.area = lane(all.area, i);
    face.spin = lane(all.spin, i);
    face.massPerArea = lane(all.massPerArea, i);
  }
}

/// The pairs of the last search, one beside the other.
struct PairTables
{
  PlaneTable* table;    ///< makes planes
  Plane* const* planes; ///< null: none yet
  const SlotFaces* slots;
  Activity* activity;
  const JointLaw* laws;
  bool incremental;          ///< closures are sums of increments
  PassedOnChanges* passedOn; ///< of what planes pass on
  /// By face: 1 where other slots are loaded now (ForceSums); null: nobody asks.
  std::uint8_t* changedFaces = nullptr;
  const PairDistances* distances = nullptr; ///< null: all pairs are looked at
  Real* gains = nullptr;                    ///< by slot, gainOf() its plane [J]; null: nobody asks

  PassedOn passedBy(int p) const { return {*planes[p], laws[planes[p]->joint], incremental}; }
  /// After a pair has been evaluated; `before`: passedBy() before that.
  void book(int p, const PassedOn& before) const
  {
    setActivity(p, activityOf(*planes[p]));
    const auto isSaid = [](const std::atomic<bool>& what)
    { return what.load(std::memory_order_relaxed); };
    if (isSaid(passedOn->changed) && isSaid(passedOn->deeper))
      return;
    const PassedOn now = passedBy(p);
    if (!isSaid(passedOn->changed) && now != before)
      passedOn->changed.store(true, std::memory_order_relaxed);
    if (!now.isAsDeepAs(before))
      passedOn->deeper.store(true, std::memory_order_relaxed);
  }
  bool isAsleep(int p) const { return activity[p] == Activity::Asleep; }
  /// Leaves out a pair whose shadows meet, and that has been looked at in full once, if its faces
  /// are so far from each other that they will not touch. Its plane is not told yet, nor made if
  /// there is none.
  /// @returns whether it did
  bool leaveOut(int p, const HalfStepFace& a, const HalfStepFace& b, Real lookAhead) const
  {
    if (!carriesNothing(p) || distances == nullptr || !distances->mayBeLeftOut(p) ||
        !areApart(a, b, distances->reach(), lookAhead))
      return false;
    putApart(p);
    return true;
  }
  bool carriesNothing(int p) const
  {
    return activity[p] == Activity::Asleep || activity[p] == Activity::Apart;
  }
  void putApart(int p) const
  {
    if (activity[p] == Activity::Apart)
      return;
    if (planes[p] != nullptr)
      planes[p]->unseen = true;
    setActivity(p, Activity::Apart);
  }
  bool carries(int p) const { return planes[p] != nullptr && planes[p]->area > 0; }
  /// For a pair that carries nothing and whose shadows share nothing.
  template <int Dim>
  void passBy(int p, const HalfStepFace& a, const HalfStepFace& b, Real dt) const
  {
    if (isAsleep(p))
      return;
    if (planes[p] != nullptr)
      coplane::passBy<Dim>(*planes[p], a, b, dt);
    const bool pushesOn = planes[p] != nullptr && planes[p]->pushes();
    setActivity(p, pushesOn ? Activity::Loaded : Activity::Asleep);
  }
  void setActivity(int p, Activity now) const
  {
    if (changedFaces != nullptr && (activity[p] == Activity::Loaded) != (now == Activity::Loaded))
      for (const std::int32_t face : slots[p].face)
        __atomic_store_n(&changedFaces[face], std::uint8_t(1), __ATOMIC_RELAXED); // by any thread
    activity[p] = now;
    if (gains != nullptr && planes[p] != nullptr)
      gains[p] = gainOf(*planes[p]);
  }
  /// Before a pair is evaluated that its faces have just brought near.
  void prepare(int p) const
  {
    if (table != nullptr)
      table->wake(std::size_t(p));
  }
};

/// Steps B to H for pairs that are near. They wait until as many of a kind, by the numbers of nodes
/// of their faces, are there as fit side by side: those without traction first for the question
/// whether their shadows can meet at all. Of those that sleep nothing but their faces is read.
template <int Dim>
class PairLanes
{
public:
  PairLanes(const PairTables& pairs, const HalfStepFace* faces, const ContactOptions& options,
            Real dt)
      : pairs_(pairs), slots_(pairs.slots), faces_(faces), laws_(pairs.laws), options_(options),
        leastOpposed_(leastOpposed(options)), dt_(dt)
  {
  }

  /// @param near slots that have faces, ascending
  void update(const int* near, int count)
  {
    for (int i = 0; i < count; ++i)
    {
      prefetchAhead(near, i, count);
      sort(near[i]);
    }
    for (int kind = 0; kind < kinds; ++kind)
      judge(kind);
    for (Queue& queue : toUpdate_)
      updateMet(queue);
  }

  static constexpr int atOnce = 512; ///< slots: many enough that few lanes stay empty at their end

private:
  static constexpr int kinds = 4;
  struct Queue
  {
    int count = 0;
    int plane[laneCount];

    /// Whether it is full now.
    bool add(int p)
    {
      plane[count++] = p;
      return count == laneCount;
    }
    /// Lanes without a plane of their own repeat the first.
    int at(int i) const { return plane[i < count ? i : 0]; }
  };

  /// Puts a pair to its kind.
  void sort(int p)
  {
    const HalfStepFace &a = face(p, 0), &b = face(p, 1);
    // Edge neighbours at a right angle, say.
    if (pairs_.isAsleep(p) && !(-dot(a.normal, b.normal) > leastOpposed_))
      return;
    const int kind = (a.count == 4 ? 1 : 0) + (b.count == 4 ? 2 : 0);
    if (!pairs_.carriesNothing(p) && pairs_.carries(p)) // it met in the last cycle
      put(p, kind);
    else if (toJudge_[kind].add(p))
      judge(kind);
  }

  /// Planes lie in a row, and so do their lower faces nearly; the higher ones lie anywhere.
  void prefetchAhead(const int* near, int i, int count) const
  {
    constexpr int planesAhead = 16, facesAhead = 8;
    if (i + planesAhead < count)
      if (const int p = near[i + planesAhead];
          !pairs_.carriesNothing(p) && pairs_.planes[p] != nullptr)
        prefetchToWrite(pairs_.planes[p]);
    if (i + facesAhead < count)
      prefetch(&face(near[i + facesAhead], 1));
  }

  const HalfStepFace& face(int p, int side) const { return faces_[slots_[p].face[side]]; }

  template <bool WithMotion>
  void gatherFaces(const Queue& queue)
  {
    const HalfStepFace *a[laneCount], *b[laneCount];
    for (int i = 0; i < laneCount; ++i)
    {
      a[i] = &face(queue.at(i), 0);
      b[i] = &face(queue.at(i), 1);
    }
    putSideBySide<WithMotion>(a, a_);
    putSideBySide<WithMotion>(b, b_);
  }

  void judge(int kind)
  {
    Queue& queue = toJudge_[kind];
    if (queue.count == 0)
      return;
    gatherFaces<false>(queue);
    const LaneMask meet = mayMeet<Dim>(a_, b_, options_);
    for (int i = 0; i < queue.count; ++i)
    {
      const int p = queue.plane[i];
      if (!meet[i])
        pairs_.template passBy<Dim>(p, face(p, 0), face(p, 1), dt_);
      else if (!pairs_.leaveOut(p, face(p, 0), face(p, 1), options_.lookAhead))
      {
        pairs_.prepare(p);
        put(p, kind);
      }
    }
    queue.count = 0;
  }

  void put(int p, int kind)
  {
    // Those that carry are packed together: most of the others are done when they do not touch.
    Queue& queue = toUpdate_[kind + (pairs_.carries(p) ? kinds : 0)];
    if (queue.add(p))
      updateMet(queue);
  }

  void updateMet(Queue& queue)
  {
    if (queue.count == 0)
      return;
    PlaneBatch<Lanes> batch;
    batch.count = queue.count;
    for (int i = 0; i < laneCount; ++i)
    {
      batch.plane[i] = pairs_.planes[queue.at(i)];
      batch.law[i] = &laws_[batch.plane[i]->joint];
    }
    gatherFaces<true>(queue);
    PassedOn before[laneCount];
    for (int i = 0; i < queue.count; ++i)
      before[i] = pairs_.passedBy(queue.plane[i]);
    LaneMask done(false);
    // In two dimensions forces along the common normal, and rings, are found pair by pair.
    if constexpr (Dim == 3)
      done = updateByForces<Dim, Lanes>(batch, a_, b_, options_, dt_);
    else if (options_.forces == ContactOptions::Forces::Potential && !options_.axisymmetric)
      done = updatePotentialPlanes<Dim, Lanes>(batch, a_, b_, options_, dt_);
    for (int i = 0; i < queue.count; ++i)
      if (!done[i])
        updateByForces<Dim>(*batch.plane[i], face(queue.plane[i], 0), face(queue.plane[i], 1),
                            *batch.law[i], options_, dt_);
    for (int i = 0; i < queue.count; ++i)
      pairs_.book(queue.plane[i], before[i]);
    queue.count = 0;
  }

  const PairTables pairs_;
  const SlotFaces* slots_;
  const HalfStepFace* faces_;
  const JointLaw* laws_;
  const ContactOptions& options_;
  const Real leastOpposed_;
  Real dt_;
  Queue toJudge_[kinds], toUpdate_[2 * kinds];
  HalfStepFaceOf<Lanes> a_, b_; // of the pairs in work
};
} // namespace coplane
