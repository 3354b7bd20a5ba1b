// The same guide in C++, for tests and benchmarks of the Python package to compare with:
//
//   guide_of_files FOLDER THREADS LIGHT_GROUPS
//
// FOLDER holds a file for each field of OdisPathVertices that is known, NAME.bin with the numbers one after
// another. For each line on the standard input a guide is built and the seconds that it took are printed, by
// the clock and of all threads' work; at the end of the input the last guide's arrays are written to
// FOLDER/guide.
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <odis/odis.hpp>
#include <optional>

namespace {

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The arrays of a folder, and what describes them.
class Arrays {
 public:
  explicit Arrays(const std::filesystem::path& folder) : m_folder(folder) {
    using V = OdisPathVertices;
    const std::pair<const char*, OdisVertexField V::*> fields[] = {
        {"position", &V::position},
        {"normal", &V::normal},
        {"wo", &V::wo},
        {"wi", &V::wi},
        {"radiance", &V::radiance},
        {"weight", &V::weight},
        {"direct", &V::direct},
        {"pdf", &V::pdf},
        {"guidablePdf", &V::guidablePdf},
        {"guidableProbability", &V::guidableProbability},
        {"distance", &V::distance},
        {"roughness", &V::roughness},
        {"cosine", &V::cosine},
        {"indirect", &V::indirect},
        {"emission", &V::emission},
        {"light", &V::light},
        {"raysAfter", &V::raysAfter},
        {"lightGroup", &V::lightGroup},
        {"lightGroupProbability", &V::lightGroupProbability},
        {"pixel", &V::pixel},
        {"sample", &V::sample},
        {"depth", &V::depth},
        {"discrete", &V::discrete},
    };
    for (const auto& [name, field] : fields) add(name, described.*field);
    described.count = read(folder / "position.bin").size() / sizeof(odis::Float3);
  }

  OdisPathVertices described;

 private:
  void add(const char* name, OdisVertexField& field) {
    const std::filesystem::path path = m_folder / (std::string(name) + ".bin");
    if (!exists(path)) return;
    m_contents.push_back(std::make_unique<std::string>(read(path)));
    field.data = m_contents.back()->data();
  }

  std::filesystem::path m_folder;
  std::vector<std::unique_ptr<std::string>> m_contents;
};

template <class T>
void write(std::ofstream& file, const T* data, size_t count) {
  file.write(reinterpret_cast<const char*>(data), std::streamsize(count * sizeof(T)));
}

void writeGuide(const odis::Guide& guide, const std::filesystem::path& path) {
  const odis::GuideView view = guide.view();
  std::ofstream file(path, std::ios::binary);
  write(file, view.keys, view.cellCount);
  write(file, view.maps, size_t(view.cellCount) * odis::kMapShares);
  write(file, view.decisions, view.cellCount);
  if (view.lightGroups > 0) write(file, view.lightTables, size_t(view.cellCount) * (view.lightGroups + 1));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: guide_of_files FOLDER THREADS LIGHT_GROUPS\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  const Arrays arrays(folder);
  odis::ContextOptions contextOptions;
  contextOptions.threads = uint32_t(std::stoul(argv[2]));
  const odis::Context context(contextOptions);
  odis::GuideOptions options;
  options.lightGroups = uint32_t(std::stoul(argv[3]));
  std::optional<odis::Guide> guide;
  for (std::string line; std::getline(std::cin, line);) {
    guide.reset();
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t work = std::clock();
    odis::GuideBuilder builder(options, context);
    builder.add(arrays.described);
    guide = builder.build();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    std::printf("%.6f %.6f\n", seconds.count(), double(std::clock() - work) / CLOCKS_PER_SEC);
    std::fflush(stdout);
  }
  if (guide) writeGuide(*guide, folder / "guide");
}
