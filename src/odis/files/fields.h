// Structs in files, field by field: one array a field, "NAME.FIELD". A field that is added does not end older
// files, in which it has its default, nor does one that is gone: fields are found by their names, and what is
// not known is not looked at. A struct lists what is saved of it:
//
//   template <class Body>
//   constexpr void forEachField(FieldsOf<Place>, const Body& body) {
//     body("position", &Place::position);
//     body("normal", &Place::normal);
//   }
#pragma once

#include <array>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "odis/files/archive.h"

namespace odis::core {

// Chooses the list of a struct's fields.
template <class T>
struct FieldsOf {};

// The bytes of one field. Numbers and arrays of numbers, truth values, vectors.
template <class Field>
using FieldBytes = std::array<unsigned char, sizeof(Field)>;

// The bytes of all fields that are listed.
template <class T>
constexpr size_t listedBytes() {
  size_t bytes = 0;
  forEachField(FieldsOf<T>(), [&bytes]<class Field>(const char*, Field T::*) { bytes += sizeof(Field); });
  return bytes;
}

// Saves so many structs; `at(i)` is one.
template <class T, class At>
void saveFieldsAt(ArchiveWriter& file, const std::string& name, size_t count, const At& at) {
  forEachField(FieldsOf<T>(), [&]<class Field>(const char* field, Field T::*member) {
    static_assert(std::is_trivially_copyable_v<Field>);
    std::vector<FieldBytes<Field>> column(count);
    for (size_t i = 0; i < count; ++i) {
      const T& item = at(i);
      std::memcpy(column[i].data(), &(item.*member), sizeof(Field));
    }
    file.add(name + "." + field, column);
  });
}
template <class T>
void saveFields(ArchiveWriter& file, const std::string& name, std::span<const T> items) {
  saveFieldsAt<T>(file, name, items.size(), [&](size_t i) -> const T& { return items[i]; });
}
template <class T>
void saveFields(ArchiveWriter& file, const std::string& name, const std::vector<T>& items) {
  saveFields(file, name, std::span<const T>(items));
}
template <class T>
void saveFields(ArchiveWriter& file, const std::string& name, const T& item) {
  saveFields(file, name, std::span<const T>(&item, 1));
}

// How many structs a file has under a name. Throws FileError where it has none of their fields, or more of
// one than of another.
template <class T>
size_t countFields(const Archive& file, const std::string& name) {
  std::optional<size_t> count;
  forEachField(FieldsOf<T>(), [&]<class Field>(const char* field, Field T::*) {
    const std::string column = name + "." + field;
    if (!file.contains(column)) return;
    const size_t found = file.count<FieldBytes<Field>>(column);
    file.require(count.value_or(found) == found, column + ": has another number of elements than expected");
    count = found;
  });
  file.require(count.has_value(), "has no array of \"" + name + "\"");
  return *count;
}

// The structs of a file, of which there must be `count`; fields that the file lacks have their defaults.
// Throws FileError, also for truth values that are none.
template <class T>
std::vector<T> loadFields(const Archive& file, const std::string& name, size_t count) {
  file.require(countFields<T>(file, name) == count, name + ": has another number of elements than expected");
  std::vector<T> items(count);
  forEachField(FieldsOf<T>(), [&]<class Field>(const char* field, Field T::*member) {
    const std::string column = name + "." + field;
    if (!file.contains(column)) return;
    const auto bytes = file.get<FieldBytes<Field>>(column);
    for (size_t i = 0; i < count; ++i) {
      if constexpr (std::is_same_v<Field, bool>) file.require(bytes[i][0] <= 1, column + ": is damaged");
      std::memcpy(&(items[i].*member), bytes[i].data(), sizeof(Field));
    }
  });
  return items;
}
template <class T>
std::vector<T> loadFields(const Archive& file, const std::string& name) {
  return loadFields<T>(file, name, countFields<T>(file, name));
}
template <class T>
T loadFieldsOfOne(const Archive& file, const std::string& name) {
  return loadFields<T>(file, name, 1)[0];
}

}  // namespace odis::core
