// Builders that are merged: the same guide for any order and nesting, one part an id.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <sstream>

#include "odis/files/archive.h"
#include "odis/floor_under_patch.h"
#include "odis/same_guide.h"
#include "support/models.h"

namespace odis::core {
namespace {

const Float3 kBoxLower{0, 0, 0}, kBoxUpper{1, 1, 0.5f};

GuideOptions mergeOptions(const std::optional<Model>& model) {
  GuideOptions options;
  options.model = model;
  options.lightGroups = 3;
  options.cached = true;
  options.cachedError = 0.5f;
  options.maxDepth = 9;
  return options;
}

// What the part with this id sees: other light, other places, more than one call.
std::vector<PathVertex> verticesOfPart(uint64_t id, int count = 4000) {
  const Float3 towards = id % 2 == 0 ? kBright : Float3{-0.6f, 0, 0.8f};
  std::vector<PathVertex> vertices = floorUnderPatch(towards, count, int(10 + id));
  for (size_t i = 0; i < vertices.size(); ++i) {
    PathVertex& v = vertices[i];
    v.position.x = 0.8f * v.position.x + 0.1f * float(id % 3);
    v.pixel = uint32_t(1000 * id + i % 500);
    v.sample = uint32_t(i);
    v.direct = {0.5f, 0.25f, float(i % 3)};
    v.lightGroup = uint32_t(i % 3);
    v.lightGroupProbability = 1.0f / 3;
    v.distance = float(1 + i % 5);
  }
  return vertices;
}

GuideBuilder builderOfPart(uint64_t id, const std::optional<Model>& model, bool guidedToo = true) {
  GuideBuilder builder(mergeOptions(model));
  builder.setPartId(id);
  builder.setBounds(kBoxLower, kBoxUpper);
  builder.add(verticesOfPart(id));
  if (guidedToo) builder.addGuided(verticesOfPart(id + 100, 1000));
  return builder;
}

void mergeInto(GuideBuilder& into, std::initializer_list<const GuideBuilder*> others) {
  into.merge({others.begin(), others.size()});
}

std::string savedBytes(const GuideBuilder& builder) {
  ArchiveWriter file("builder");
  builder.save(file);
  std::ostringstream stream;
  file.write(stream);
  return stream.str();
}

GuideBuilder readBuilder(const std::string& bytes, const std::optional<Model>& model) {
  return GuideBuilder::load(Archive::parse("merged", bytes), model, libraryTasks());
}

TEST(Merging, GivesTheSameBitsForAnyOrderAndNesting) {
  for (const std::optional<Model>& model : {std::optional(Model()), std::optional<Model>()}) {
    GuideBuilder inOrder = builderOfPart(1, model), backwards(mergeOptions(model)),
                 left = builderOfPart(3, model), right = builderOfPart(4, model);
    const GuideBuilder one = builderOfPart(1, model), two = builderOfPart(2, model),
                       three = builderOfPart(3, model), four = builderOfPart(4, model);
    mergeInto(inOrder, {&two, &three, &four});
    mergeInto(backwards, {&four, &three});
    mergeInto(backwards, {&two, &one});
    mergeInto(left, {&one});
    mergeInto(right, {&two, &left});
    const Guide expected = inOrder.build();
    EXPECT_EQ(inOrder.partCount(), 4u);
    EXPECT_EQ(inOrder.vertexCounts().accepted, 20000u);
    EXPECT_GT(expected.view().cellCount, 100u);
    EXPECT_LT(expected.predictedVarianceRatio(), 1);
    EXPECT_GT(expected.view().cachedShareCount, 0u);
    EXPECT_TRUE(sameGuide(backwards.build(), expected));
    EXPECT_TRUE(sameGuide(right.build(), expected));
    EXPECT_FALSE(sameGuide(left.build(), expected));
    // By files as well.
    GuideBuilder read = readBuilder(savedBytes(left), model);
    read.merge(std::vector<const GuideBuilder*>{&four, &two});
    EXPECT_TRUE(sameGuide(read.build(), expected));
    EXPECT_EQ(savedBytes(read), savedBytes(readBuilder(savedBytes(read), model)));
  }
}

// Sums of several builders are not those of one to the bit, but nearly; what was seen in many parts counts in
// each cell.
TEST(Merging, IsNearlyWhatOneBuilderLearnsFromAll) {
  GuideBuilder merged(mergeOptions(std::nullopt)), whole(mergeOptions(std::nullopt));
  whole.setBounds(kBoxLower, kBoxUpper);
  for (const uint64_t id : {1, 3, 5, 7}) {
    const GuideBuilder part = builderOfPart(id, std::nullopt, false);
    mergeInto(merged, {&part});
    whole.add(verticesOfPart(id));
  }
  const Guide one = whole.build(), sum = merged.build();
  EXPECT_EQ(one.view().cellCount, sum.view().cellCount);
  EXPECT_NEAR(one.predictedVarianceRatio(), sum.predictedVarianceRatio(), 0.01);
  double difference = 0, count = 0;
  for (const PathVertex& v : verticesOfPart(9)) {
    const uint32_t a = findCell(one.view(), {v.position, v.normal}),
                   b = findCell(sum.view(), {v.position, v.normal});
    ASSERT_EQ(a == kNoCell, b == kNoCell);
    if (a == kNoCell) continue;
    const SamplingMap<float> first(one.view().maps, int32_t(a)), second(sum.view().maps, int32_t(b));
    difference += std::abs(first.pdf(v.wi) - second.pdf(v.wi));
    ++count;
  }
  EXPECT_GT(count, 1000);
  EXPECT_LT(difference / count, 0.01);
}

TEST(Merging, APartAloneIsTheBuilderItself) {
  const GuideBuilder part = builderOfPart(7, std::nullopt);
  GuideBuilder merged(mergeOptions(std::nullopt));
  mergeInto(merged, {&part});
  EXPECT_TRUE(sameGuide(merged.build(), part.build()));
  // A builder with that part's id goes on where it was.
  merged.setPartId(8);
  GuideBuilder heir(mergeOptions(std::nullopt));
  heir.setPartId(7);
  mergeInto(heir, {&merged});
  GuideBuilder same = builderOfPart(7, std::nullopt);
  for (GuideBuilder* builder : {&heir, &same}) builder->add(verticesOfPart(20));
  EXPECT_EQ(heir.partCount(), 1u);
  EXPECT_TRUE(sameGuide(heir.build(), same.build()));
}

// What a merged builder is taught is of its own part; the others stay what they are.
TEST(Merging, AMergedBuilderLearnsOn) {
  GuideBuilder before = builderOfPart(2, std::nullopt), after = builderOfPart(2, std::nullopt);
  const GuideBuilder other = builderOfPart(1, std::nullopt);
  mergeInto(before, {&other});
  before.add(verticesOfPart(30));
  after.add(verticesOfPart(30));
  mergeInto(after, {&other});
  const Guide guide = before.build();
  EXPECT_TRUE(sameGuide(guide, after.build()));
  // Cells that are new lie between those of the other parts, and have their parents' fractions.
  std::vector<PathVertex> far = verticesOfPart(31);
  for (PathVertex& v : far) v.position.y += 0.4f;
  for (GuideBuilder* builder : {&before, &after}) builder->addGuided(far);
  const Guide rebuilt = before.rebuild(guide);
  EXPECT_GT(rebuilt.view().cellCount, guide.view().cellCount);
  EXPECT_EQ(rebuilt.predictedVarianceRatio(), guide.predictedVarianceRatio());
  for (uint32_t c = 0; c < guide.view().cellCount; ++c) {
    const uint64_t* keys = rebuilt.view().keys;
    const auto same = size_t(std::find(keys, keys + rebuilt.view().cellCount, guide.view().keys[c]) - keys);
    ASSERT_LT(same, rebuilt.view().cellCount);
    ASSERT_TRUE(sameBits(rebuilt.view().decisions[same].bsdfFraction, guide.view().decisions[c].bsdfFraction,
                         kRoughnessClasses));
  }
}

TEST(Merging, AllPartsFadeMoveAndAreForgotten) {
  const auto make = [](bool mergeFirst, const auto& change) {
    GuideBuilder into = builderOfPart(2, std::nullopt), other = builderOfPart(1, std::nullopt);
    if (!mergeFirst) {
      change(into);
      change(other);
    }
    mergeInto(into, {&other});
    if (mergeFirst) change(into);
    return into.build();
  };
  const auto fade = [](GuideBuilder& builder) { builder.fade(0.25f); };
  EXPECT_TRUE(sameGuide(make(true, fade), make(false, fade)));
  const auto move = [](GuideBuilder& builder) { builder.setBounds(kBoxLower, kBoxUpper * 2.0f); };
  EXPECT_TRUE(sameGuide(make(true, move), make(false, move)));
  GuideBuilder forgetful = builderOfPart(2, std::nullopt), fresh = builderOfPart(2, std::nullopt);
  const GuideBuilder other = builderOfPart(1, std::nullopt);
  mergeInto(forgetful, {&other});
  forgetful.forget();
  EXPECT_EQ(forgetful.partCount(), 0u);
  EXPECT_EQ(forgetful.vertexCounts().accepted, 0u);
  forgetful.setBounds(kBoxLower, kBoxUpper);
  forgetful.add(verticesOfPart(2));
  forgetful.addGuided(verticesOfPart(102, 1000));
  EXPECT_TRUE(sameGuide(forgetful.build(), fresh.build()));
}

TEST(Merging, PixelsArePixelsOfOneImage) {
  GuideBuilder merged = builderOfPart(0, std::nullopt);
  const GuideBuilder other = builderOfPart(1, std::nullopt);
  mergeInto(merged, {&other});
  EXPECT_THROW(merged.build(std::vector<float>(1000, 1.0f)), std::out_of_range);
  std::vector<float> values(1500, 1.0f);
  const Guide even = merged.build(values);
  std::fill_n(values.begin(), 500, 100.0f);  // of pixels of the first part
  EXPECT_NE(merged.build(values).predictedVarianceRatio(), even.predictedVarianceRatio());
}

void expectRefusal(GuideBuilder& into, const GuideBuilder& other, const std::string& part) {
  const Guide before = into.build();
  try {
    const GuideBuilder fits = builderOfPart(50, std::nullopt);
    mergeInto(into, {&fits, &other});
    ADD_FAILURE() << part;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
  EXPECT_EQ(into.partCount(), 1u);
  EXPECT_TRUE(sameGuide(into.build(), before)) << part;
}

TEST(Merging, WhatDoesNotFitIsRefusedByName) {
  GuideBuilder into = builderOfPart(1, std::nullopt);
  const auto differing = [&](const auto& change) {
    GuideOptions options = mergeOptions(std::nullopt);
    change(options);
    GuideBuilder builder(options);
    builder.setPartId(2);
    builder.setBounds(kBoxLower, kBoxUpper);
    builder.add(verticesOfPart(2));
    return builder;
  };
  expectRefusal(into, differing([](GuideOptions& o) { o.clamp = 10; }), "differ in map-clamp");
  expectRefusal(into, differing([](GuideOptions& o) { o.priorSamples[2] = 1; }), "differ in prior-samples");
  expectRefusal(into, differing([](GuideOptions& o) { o.lightGroups = 4; }), "differ in lightGroups");
  expectRefusal(into, differing([](GuideOptions& o) { o.controlVariate = false; }), "differ in ended-paths");
  expectRefusal(into, differing([](GuideOptions& o) { o.model = Model(); }), "differ in model");
  const OdisLightParts lights{0, 2};
  expectRefusal(into, differing([&](GuideOptions& o) { o.lightParts = {lights}; }), "differ in lightParts");
  GuideBuilder elsewhere(mergeOptions(std::nullopt));
  elsewhere.setPartId(2);
  elsewhere.add(verticesOfPart(2));
  expectRefusal(into, elsewhere, "odisSetBounds");
  expectRefusal(into, builderOfPart(1, std::nullopt), "two parts have the id 1");
  expectRefusal(into, builderOfPart(50, std::nullopt), "two parts have the id 50");
  expectRefusal(into, into, "two parts have the id 1");
  GuideBuilder whole = builderOfPart(3, std::nullopt);
  mergeInto(whole, {&into});
  EXPECT_THROW(whole.setPartId(1), std::invalid_argument);
  // Nothing differs where nothing was added.
  GuideBuilder nothing(mergeOptions(std::nullopt));
  nothing.setPartId(1);
  mergeInto(into, {&nothing});
  EXPECT_EQ(into.partCount(), 1u);
}

// Whoever delivers the vertices of a call in any order gets the same sums.
TEST(Merging, VerticesOfOneCallMayComeInAnyOrder) {
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 60000, 9);
  for (size_t i = 0; i < vertices.size(); ++i) {
    vertices[i].pixel = uint32_t(i / 6);
    vertices[i].sample = uint32_t(i / 3 % 2);
    vertices[i].depth = uint16_t(1 + i % 3);
  }
  const GuideOptions options = mergeOptions(std::nullopt);
  GuideBuilder expected(options), shuffled(options), paths(options);
  expected.add(vertices);
  expected.addGuided(vertices);
  std::mt19937 engine(1);
  std::vector<PathVertex> permuted = vertices;
  std::shuffle(permuted.begin(), permuted.end(), engine);
  shuffled.add(permuted);
  shuffled.addGuided(permuted);
  std::vector<ArrayView<const PathVertex>> parts;
  for (size_t i = 0; i < vertices.size(); i += 3)
    parts.push_back(ArrayView<const PathVertex>(vertices).subview(i, 3));
  std::shuffle(parts.begin(), parts.end(), engine);
  paths.add(parts);
  paths.addGuided(parts);
  EXPECT_TRUE(sameGuide(shuffled.build(), expected.build()));
  EXPECT_TRUE(sameGuide(paths.build(), expected.build()));
}

}  // namespace
}  // namespace odis::core
