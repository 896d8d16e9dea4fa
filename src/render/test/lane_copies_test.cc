// Every member of the types over F goes into a lane and out of it again.

#include <gtest/gtest.h>

#include <cstring>

#include "render/kernel/camera/channels.h"
#include "render/kernel/interactive/reflection.h"

namespace gloam {
namespace {

// Values that differ from member to member and from lane to lane, and from the defaults.
void fill(float* x, int* next) { *x = static_cast<float>(1000 + ++*next); }
void fill(uint32_t* x, int* next) { *x = static_cast<uint32_t>(1000 + ++*next); }
void fill(bool* x, int* next) { *x = ++*next % 2 == 0; }
template <class T>
void fill(T* value, int* next);

template <class T, auto... kMembers>
void fill_members(T* value, int* next, MemberList<kMembers...>) {
  (fill(&(value->*kMembers), next), ...);
}
template <class T>
void fill(T* value, int* next) {
  fill_members(value, next, MembersOf<T>{});
}

void expect_same(float a, float b) { EXPECT_EQ(a, b); }
void expect_same(uint32_t a, uint32_t b) { EXPECT_EQ(a, b); }
void expect_same(bool a, bool b) { EXPECT_EQ(a, b); }
template <class T>
void expect_same(const T& a, const T& b);

template <class T, auto... kMembers>
void expect_same_members(const T& a, const T& b, MemberList<kMembers...>) {
  (expect_same(a.*kMembers, b.*kMembers), ...);
}
template <class T>
void expect_same(const T& a, const T& b) {
  expect_same_members(a, b, MembersOf<T>{});
}

template <template <class> class Of>
struct Type {
  using Single = Of<float>;
  using Lanes = Of<FloatLanes>;
};

template <class T>
class LaneCopies : public testing::Test {};
using LaneTypes = testing::Types<Type<Vec2Of>, Type<Vec3Of>, Type<AffineOf>, Type<RayOf>,
                                 Type<RayHitOf>, Type<RayConeOf>, Type<SurfaceOf>, Type<BsdfOf>,
                                 Type<LayeredBsdfOf>, Type<LightSampleOf>>;
TYPED_TEST_SUITE(LaneCopies, LaneTypes);

TYPED_TEST(LaneCopies, EveryLaneKeepsItsOwnMembers) {
  typename TypeParam::Single values[kLaneCount];
  typename TypeParam::Lanes lanes;
  int next = 0;
  for (int i = 0; i < kLaneCount; ++i) {
    fill(&values[i], &next);
    set_lane(&lanes, i, values[i]);
  }
  for (int i = 0; i < kLaneCount; ++i) expect_same(values[i], lane(lanes, i));
}

TYPED_TEST(LaneCopies, OneLaneGoesIntoAnother) {
  typename TypeParam::Lanes from, to;
  int next = 0;
  typename TypeParam::Single moved, kept;
  fill(&moved, &next);
  fill(&kept, &next);
  set_lane(&from, 5, moved);
  set_lane(&to, 1, kept);
  copy_lane(from, 5, &to, 2);
  expect_same(kept, lane(to, 1));
  expect_same(moved, lane(to, 2));
}

TYPED_TEST(LaneCopies, SelectionTakesAllMembersOfALane) {
  typename TypeParam::Lanes a, b;
  typename TypeParam::Single of_a, of_b;
  int next = 0;
  fill(&of_a, &next);
  fill(&of_b, &next);
  MaskLanes first = false;
  for (int i = 0; i < kLaneCount; ++i) {
    set_lane(&a, i, of_a);
    set_lane(&b, i, of_b);
    set_lane(&first, i, i % 3 == 0);
  }
  const typename TypeParam::Lanes chosen = select<FloatLanes>(first, a, b);
  for (int i = 0; i < kLaneCount; ++i) {
    expect_same(i % 3 == 0 ? of_a : of_b, lane(chosen, i));
  }
}

// These have lists of another kind, or members without a lane of their own.

TEST(LaneCopies, ExactChannelsKeepTheirs) {
  ExactChannels one;
  int next = 0, members = 0;
  const auto put = [&](auto& member) {
    fill(&member, &next);
    ++members;
  };
  visit_places(put, one);
  visit_details(put, one);
  EXPECT_EQ(members, members::count<ExactChannels>());
  ExactChannelsOf<FloatLanes> lanes;
  const auto set = [](auto& to, const auto& from) { set_lane(&to, 3, from); };
  visit_places(set, lanes, one);
  visit_details(set, lanes, one);
  const auto expect = [](const auto& a, const auto& b) { expect_same(a, b); };
  const ExactChannels out = lane(lanes, 3);
  visit_places(expect, one, out);
  visit_details(expect, one, out);
}

TEST(LaneCopies, ReflectedRaysTakeTheirSamplersAndLampsAlong) {
  ReflectedRayOf<FloatLanes> from, to;
  Ray ray;
  int next = 0;
  fill(&ray, &next);
  set_lane(&from.ray, 4, ray);
  set_lane(&from.cone_spread, 4, 0.5f);
  set_lane(&from.normal, 4, {1, 2, 3});
  set_lane(&from.flames, 4, false);
  const LampCell cell{};
  from.lists.set(4, &cell);
  UintLanes x = 0u;
  for (int i = 0; i < kLaneCount; ++i) set_lane(&x, i, static_cast<uint32_t>(i));
  from.sampler = SamplerOf<FloatLanes>::make(7, 2, x, UintLanes(9u), UintLanes(0u), 0);
  from.sampler.next_1d();

  copy_lane(from, 4, &to, 6);
  expect_same(ray, lane(to.ray, 6));
  EXPECT_EQ(lane(to.cone_spread, 6), 0.5f);
  expect_same(Vec3f{1, 2, 3}, lane(to.normal, 6));
  EXPECT_FALSE(lane(to.flames, 6));
  EXPECT_TRUE(lane(to.flames, 5));
  EXPECT_EQ(to.lists.of[6], &cell);
  EXPECT_TRUE(lane(to.lists.known, 6));
  EXPECT_FALSE(lane(to.lists.known, 5));
  EXPECT_EQ(lane(to.sampler.next_1d(), 6), lane(from.sampler.next_1d(), 4));
}

// A list that lacks a member differs from a complete one.
struct Short {
  float a = 0, b = 0;
  Vec3f c;
  bool d = false;
};
static_assert(members::count<Short>() == 4);
static_assert(members::count<Surface>() == Surface::Members::kCount);

}  // namespace
}  // namespace gloam
