// Weights as files, and what the networks make of them.
#include <gtest/gtest.h>
#include "odis/models/model.h"

#include <fstream>

#include "odis/models/direction_network.h"
#include "odis/models/light_network.h"
#include "odis/models/model.h"

namespace odis::core {
namespace {

// A network of two hidden units whose blend does not depend on the cell: these logits.
Weights constantBlend(const std::vector<float>& logits) {
  const uint32_t inputs = kCellScalars, maps = kBasisMaps;
  return Weights("{\"made\": \"by hand\"}",
                 {{"directions.cell.mean", {inputs}, std::vector<float>(inputs, 0.0f)},
                  {"directions.cell.scale", {inputs}, std::vector<float>(inputs, 1.0f)},
                  {"directions.cell.0.weight", {2, inputs}, std::vector<float>(2 * inputs, 0.25f)},
                  {"directions.cell.0.bias", {2}, {0, 1}},
                  {"directions.cell.1.weight", {2, 2}, {1, -1, 0.5f, 0}},
                  {"directions.cell.1.bias", {2}, {0, 0}},
                  {"directions.blend.weight", {maps, 2}, std::vector<float>(2 * maps, 0.0f)},
                  {"directions.blend.bias", {maps}, logits}});
}

CellStatistics brightCell() {
  CellStatistics cell;
  cell.count = 10;
  cell.sum = 5;
  cell.sumSquares = 5;
  cell.normal = {0, 0, 10};
  cell.histogram[size_t(texelOf(Float3{0.6f, 0, 0.8f}))] = 5;
  return cell;
}

TEST(Weights, AreTheSameAfterWritingAndReading) {
  const Weights weights = constantBlend({0, 1, 2, 3, 4, 5, 6, 7, 8});
  const Weights again = Weights::parse("again", weights.bytes());
  EXPECT_EQ(again.about(), weights.about());
  ASSERT_EQ(again.tensors().size(), weights.tensors().size());
  for (size_t i = 0; i < weights.tensors().size(); ++i) {
    EXPECT_EQ(again.tensors()[i].name, weights.tensors()[i].name);
    EXPECT_EQ(again.tensors()[i].shape, weights.tensors()[i].shape);
    EXPECT_EQ(again.tensors()[i].values, weights.tensors()[i].values);
  }
  EXPECT_EQ(again.bytes(), weights.bytes());
}

std::string errorOf(const std::string& bytes) {
  try {
    Weights::parse("some.weights", bytes);
  } catch (const WeightsError& error) {
    return error.what();
  }
  return "";
}

TEST(Weights, DamagedFilesAreRefused) {
  const std::string bytes = constantBlend(std::vector<float>(kBasisMaps)).bytes();
  EXPECT_EQ(errorOf(bytes), "");
  for (const size_t length :
       {size_t(0), size_t(7), size_t(11), size_t(30), bytes.size() / 2, bytes.size() - 1})
    EXPECT_NE(errorOf(bytes.substr(0, length)), "") << length;
  for (size_t at = 0; at < bytes.size(); at += 37) {
    std::string damaged = bytes;
    damaged[at] = char(damaged[at] ^ 16);
    EXPECT_NE(errorOf(damaged), "") << at;
  }
  EXPECT_NE(errorOf("P6 640 360 255 and so on").find("expected it to begin with ODISNETW"),
            std::string::npos);
}

TEST(Weights, OfOtherNumbersMakeAnotherModel) {
  const auto idWith = [](float first) {
    std::vector<float> blend(kBasisMaps);
    blend[0] = first;
    return idOf(Model::parse("some.weights", constantBlend(blend).bytes()));
  };
  EXPECT_EQ(idWith(1), idWith(1));
  EXPECT_NE(idWith(1), idWith(2));
}

TEST(Weights, OfOtherShapesAreRefused) {
  EXPECT_THROW(DirectionNetwork(Weights("{}", {})), WeightsError);
  std::vector<Tensor> tensors = constantBlend(std::vector<float>(kBasisMaps)).tensors();
  tensors[2].shape = {3, kCellScalars};
  tensors[2].values.resize(3 * kCellScalars);
  try {
    DirectionNetwork network(Weights("{}", tensors));
    FAIL();
  } catch (const WeightsError& error) {
    EXPECT_NE(std::string(error.what()).find("directions.cell.0.weight"), std::string::npos) << error.what();
  }
}

TEST(Weights, BuiltInOnesHoldANetwork) {
  EXPECT_TRUE(Model::builtIn().directions != nullptr);
  EXPECT_TRUE(Model::builtIn().lights != nullptr);
  EXPECT_NE(Weights::builtIn().about().find("\"config\""), std::string::npos);
  EXPECT_THROW(Model::load("no/such/file.weights"), std::runtime_error);
}

TEST(DirectionNetwork, BlendsTheMapsThatAreThere) {
  // Equal logits: the cell's histogram, its blurred one and the lobe share alike; the other maps are empty.
  const DirectionNetwork even(constantBlend(std::vector<float>(kBasisMaps, 3.0f)));
  const CellStatistics cell = brightCell();
  CellFeatures features;
  computeFeatures({&cell}, features);
  const auto shares = even.blend(features);
  for (const int map : {0, kOwnBlurred, kLobe}) EXPECT_NEAR(shares[size_t(map)], 1.0f / 3, 1e-6f) << map;
  const DirectionDistribution map = even.predict({&cell}, nullptr);
  double sum = 0;
  for (const float p : map.probability) sum += p;
  EXPECT_NEAR(sum, 1, 1e-5);
  const auto bright = size_t(texelOf(Float3{0.6f, 0, 0.8f}));
  EXPECT_NEAR(
      map.probability[bright],
      (basisMap(features, 0)[bright] + basisMap(features, kOwnBlurred)[bright] + features.lobe[bright]) / 3,
      1e-6f);

  // Only the histogram, if all others have tiny shares.
  const DirectionNetwork own(constantBlend({30, 0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_NEAR(own.predict({&cell}, nullptr).probability[bright], 1, 1e-6f);
  // A cell that has seen nothing has the lobe.
  const CellStatistics nothing;
  computeFeatures({&nothing}, features);
  EXPECT_EQ(own.predict({&nothing}, nullptr).probability, features.lobe);
  EXPECT_EQ(own.predict({&nothing}, nullptr).sensitivity, 0);
}

// A network for lights that adds the same to every group.
Weights indifferentLights() {
  const uint32_t inputs = kPairFeatures;
  return Weights("{}", {{"lights.0.weight", {2, inputs}, std::vector<float>(2 * inputs, 0.5f)},
                        {"lights.0.bias", {2}, {0, 0}},
                        {"lights.1.weight", {2, 2}, {1, 0, 0, 1}},
                        {"lights.1.bias", {2}, {0, 0}},
                        {"lights.2.weight", {1, 2}, {0, 0}},
                        {"lights.2.bias", {1}, {0.5f}}});
}

TEST(LightNetwork, WithoutAnOpinionIsTheFormula) {
  CellStatistics cell, parent;
  parent.level = 1;
  cell.lightCount = 12;
  cell.lightSquares = {12, 0, 48};
  parent.lightCount = 90;
  parent.lightSquares = {90, 90, 90};
  const LightNetwork network(indifferentLights());
  const LightSquares coarse = LightFormula().predict({&parent}, nullptr, 3),
                     formula = LightFormula().predict({&cell}, &coarse, 3),
                     learned = network.predict({&cell, &parent}, nullptr, 3);
  for (size_t g = 1; g < 3; ++g)
    EXPECT_NEAR(std::sqrt(learned[g] / learned[0]), std::sqrt(formula[g] / formula[0]), 1e-4);
  EXPECT_EQ(learned[3], 0);  // there is no fourth
  // Where no light gave anything there is nothing to learn.
  const CellStatistics dark;
  EXPECT_EQ(network.predict({&dark}, nullptr, 3), LightSquares{});
}

TEST(LightNetwork, FeaturesAreSharesCountsAndTheFormula) {
  CellStatistics cell;
  cell.lightCount = 7;
  cell.lightSquares = {9, 1};
  LightFeatures features;
  computeFeatures({&cell}, 2, features);
  EXPECT_NEAR(features.formula[0], 0.75f, 1e-6f);
  EXPECT_NEAR(features.pairs[0][0], std::log2(0.75f + 1.0f / 1024) / 4, 1e-4f);
  EXPECT_NEAR(features.pairs[0][1], std::log2(0.25f + 1.0f / 1024) / 4, 1e-4f);
  EXPECT_NEAR(features.pairs[1][0], -2.5f, 1e-4f);  // no coarser level
  EXPECT_NEAR(features.pairs[kCellLevels][0], 3.0f / 8, 1e-6f);
  EXPECT_NEAR(features.pairs[kPairFeatures - 1][1], 0.25f, 1e-6f);
  EXPECT_EQ(features.pairs[0][2], 0);
}

TEST(DirectionNetwork, SensitivityIsWhatASampleAdds) {
  const DirectionNetwork network(constantBlend({1, 0.5f, 0, 0, 0.7f, 0.2f, -1}));
  CellStatistics cell = brightCell(), parent = brightCell();
  parent.level = 1;
  parent.count = 40;
  parent.sum = 20;
  parent.histogram.fill(20.0f / kMapTexels);
  const auto texel = size_t(texelOf(Float3{0, 0.6f, 0.8f}));
  const DirectionDistribution before = network.predict({&cell, &parent}, nullptr);
  // A sample more, the sums as they were: what the histogram's normalisation makes of it is left out.
  constexpr float kValue = 0.01f;
  cell.histogram[texel] += kValue;
  parent.histogram[texel] += kValue;
  const DirectionDistribution after = network.predict({&cell, &parent}, nullptr);
  EXPECT_NEAR((after.probability[texel] - before.probability[texel]) / kValue, before.sensitivity,
              0.02f * before.sensitivity);
}

}  // namespace
}  // namespace odis::core
