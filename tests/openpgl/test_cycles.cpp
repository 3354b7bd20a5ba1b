// What Cycles imports, and calls that it made, played again by any number of threads.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <thread>

#include "openpgl/host.h"
#include "openpgl/recorded_calls.h"
#include "support/temporary_folder.h"

namespace odis::test {
namespace {

constexpr char kData[] = ODIS_SOURCE "/tests/openpgl/data/";

void play(const RecordedPath& recorded, pgl::PathSegmentStorage& path, pgl::SampleStorage& samples) {
  for (const auto& [isCopied, data] : recorded)
    if (isCopied)
      path.AddSegment(data);
    else
      *path.NextSegment() = data;
  handOver(path, samples);
  path.Clear();
}

// The densities, and the directions of samples.
void ask(const RecordedVertex& vertex, const pgl::Field& field,
         pgl::SurfaceSamplingDistribution& distribution, std::vector<float>& answers) {
  float unused = 0;
  if (!distribution.Init(&field, vertex.position, unused)) return;
  distribution.ApplyCosineProduct(vertex.normal);
  for (const auto& [samples, direction, numbers] : vertex.questions) {
    if (!samples) {
      answers.push_back(distribution.PDF(direction));
      continue;
    }
    pgl_vec3f sampled{};
    const float pdf = distribution.SamplePDF(numbers, sampled);
    answers.insert(answers.end(), {pdf, sampled.x, sampled.y, sampled.z});
    EXPECT_NEAR(pdf, distribution.PDF(sampled), 1e-4f * pdf);
  }
}

struct Played {
  std::unique_ptr<pgl::Field> field;
  std::vector<std::vector<float>> answers;  // of each vertex
  size_t updates = 0;
};

// Plays rounds one after another; thread t plays every path and vertex whose index leaves t.
Played play(const std::vector<RecordedRound>& rounds, pgl::Device& device, size_t threads) {
  pgl::FieldConfig config;
  config.Init(PGL_SPATIAL_STRUCTURE_KDTREE, PGL_DIRECTIONAL_DISTRIBUTION_PARALLAX_AWARE_VMM);
  Played played{std::make_unique<pgl::Field>(&device, config), {}, 0};
  pgl::SampleStorage samples;
  for (const RecordedRound& round : rounds) {
    const size_t before = played.answers.size();
    played.answers.resize(before + round.vertices.size());
    std::vector<std::thread> workers;
    for (size_t t = 0; t < threads; ++t)
      workers.emplace_back([&, t] {
        pgl::PathSegmentStorage path;
        pgl::SurfaceSamplingDistribution distribution(played.field.get());
        for (size_t i = t; i < round.vertices.size(); i += threads)
          ask(round.vertices[i], *played.field, distribution, played.answers[before + i]);
        for (size_t i = t; i < round.paths.size(); i += threads) play(round.paths[i], path, samples);
      });
    for (std::thread& worker : workers) worker.join();
    if (!round.isUpdated) continue;
    played.field->Update(samples);
    samples.Clear();
    ++played.updates;
  }
  return played;
}

// `nm -D --undefined-only` of Cycles' programs.
TEST(PglCycles, FindsAllThatItImports) {
  size_t programs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kData)) {
    if (entry.path().extension() != ".symbols") continue;
    ++programs;
    std::ifstream symbols(entry.path());
    size_t count = 0;
    for (std::string name; symbols >> name; ++count)
      EXPECT_TRUE(dlsym(RTLD_DEFAULT, name.c_str())) << entry.path() << ": " << name;
    EXPECT_GT(count, 30u) << entry.path();
  }
  EXPECT_GT(programs, 0u);
}

// Cycles 3.4.1 with five samples of scenes/demo at 256 x 144 pixels, one path and one vertex in 900.
TEST(PglCycles, AnswersDoNotDependOnThreads) {
  const std::vector<RecordedRound> rounds = readRecordedCalls(kData + std::string("cycles-3.4.1.calls"));
  pgl::Device device{PGL_DEVICE_TYPE_CPU_8};
  const Played one = play(rounds, device, 1);
  EXPECT_GE(one.updates, 2u);
  size_t answered = 0;
  for (const std::vector<float>& answers : one.answers) answered += !answers.empty();
  EXPECT_GT(answered, 200u);
  for (const size_t threads : {2, 5}) {
    const Played several = play(rounds, device, threads);
    EXPECT_TRUE(*one.field == *several.field) << threads;
    EXPECT_EQ(one.answers, several.answers) << threads;
  }
}

int exitCodeOf(const std::string& command) {
  return WEXITSTATUS(std::system((command + " > /dev/null 2>&1").c_str()));
}

TEST(OdisCycles, StartsWhatLinksOpenPgl) {
  const std::string wrapper = "bash " ODIS_CYCLES " ";
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  EXPECT_EQ(exitCodeOf(wrapper + self + " --gtest_list_tests"), 0);
  EXPECT_EQ(exitCodeOf(wrapper), 2);
  EXPECT_EQ(exitCodeOf(wrapper + "/bin/ls"), 2) << "which does not";
  EXPECT_EQ(exitCodeOf(wrapper + "no-such-program"), 2);
}

TEST(OdisCycles, ReadsListsOfLibrariesToTheirEnd) {
  const TemporaryFolder folder;
  std::ofstream(folder.path("ldd")) << "#!/bin/sh\necho libopenpgl.so.0\nsleep 0.2\necho libm.so.6\n";
  std::filesystem::permissions(folder.path("ldd"), std::filesystem::perms::owner_all);
  EXPECT_EQ(exitCodeOf("PATH=" + folder.path("") + ":$PATH bash " ODIS_CYCLES " true"), 0);
}

TEST(PglRecordedCalls, DamagedFilesAreNoCalls) {
  const TemporaryFolder folder;
  const std::string file = folder.path("calls");
  EXPECT_THROW(readRecordedCalls(file), std::runtime_error);
  for (const char* text : {"p?", "s cut off", "d asked nowhere"}) {
    std::ofstream(file) << text;
    EXPECT_THROW(readRecordedCalls(file), std::runtime_error) << text;
  }
}

}  // namespace
}  // namespace odis::test
