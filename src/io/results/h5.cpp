// SPDX-License-Identifier: GPL-3.0-or-later
#include "h5.hpp"

#include <algorithm>

namespace stylet::h5 {

namespace {

/// The innermost entry of HDF5's error stack carries the cause ("No space left on device").
herr_t keep_first(unsigned, const H5E_error2_t* entry, void* text) {
  auto& reason = *static_cast<std::string*>(text);
  if (reason.empty() && entry->desc != nullptr) reason = entry->desc;
  return 0;
}

Handle scalar_space() { return {check(H5Screate(H5S_SCALAR), "create dataspace"), H5Sclose}; }

Handle simple_space(std::span<const hsize_t> shape) {
  return {check(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), "create dataspace"), H5Sclose};
}

void write_numbers(hid_t object, const char* name, hid_t type, hsize_t count, const void* values) {
  const Handle space = simple_space({&count, 1});
  const Handle attribute(check(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), name), H5Aclose);
  if (count > 0) check(H5Awrite(attribute, type, values), name);
}

template <class Number>
std::vector<Number> read_numbers(hid_t object, const char* name, hid_t type) {
  const Handle attribute(check(H5Aopen(object, name, H5P_DEFAULT), name), H5Aclose);
  const Handle space(check(H5Aget_space(attribute), name), H5Sclose);
  std::vector<Number> values(static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space), name)));
  if (!values.empty()) check(H5Aread(attribute, type, values.data()), name);
  return values;
}

/// Takes the text over from memory that HDF5 allocated.
std::string take(char* text) {
  std::string copy = text == nullptr ? "" : text;
  if (text != nullptr) H5free_memory(text);
  return copy;
}

}  // namespace

namespace {
std::recursive_mutex& library() {
  static std::recursive_mutex mutex;
  return mutex;
}
}  // namespace

LibraryTurn::LibraryTurn() : alone_(library()) {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}
LibraryTurn::~LibraryTurn() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

namespace {
/// HDF5 1.10 loses what it has read of an object whose checksum is wrong, and at its own end, where it finds that, it
/// says "infinite loop closing library", unless it may not print.
struct SilentEnd {
  SilentEnd() = default;
  ~SilentEnd() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }
  SilentEnd(const SilentEnd&) = delete;
  SilentEnd& operator=(const SilentEnd&) = delete;
};
}  // namespace

void fail(const char* action) {
  static const SilentEnd before_that_of_hdf5;  // which had begun before
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &reason);
  throw Failure(std::string(action) + ": " + (reason.empty() ? "HDF5 gave no reason" : reason));
}

Handle open_file(const char* path) { return {check(H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), "open"), H5Fclose}; }

Handle open_growing_file(const char* path) {
  // The first wait is a nanosecond and each twice the one before: these are 0.13 s, HDF5's own 100 never end.
  constexpr unsigned kAttempts = 28;
  const Handle access(check(H5Pcreate(H5P_FILE_ACCESS), "open"), H5Pclose);
  check(H5Pset_metadata_read_attempts(access, kAttempts), "open");
  return {check(H5Fopen(path, H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access), "open"), H5Fclose};
}

bool has_attribute(hid_t object, const char* name) { return check(H5Aexists(object, name), name) > 0; }
bool has_link(hid_t parent, const char* name) { return check(H5Lexists(parent, name, H5P_DEFAULT), name) > 0; }

Handle group(hid_t parent, const char* name) {
  return {check(H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), name), H5Gclose};
}
Handle open_group(hid_t parent, const char* name) {
  return {check(H5Gopen2(parent, name, H5P_DEFAULT), name), H5Gclose};
}
Handle dataset(hid_t parent, const char* name) { return {check(H5Dopen2(parent, name, H5P_DEFAULT), name), H5Dclose}; }

Handle array_type(hid_t element, hsize_t count) {
  return {check(H5Tarray_create2(element, 1, &count), "create type"), H5Tclose};
}

Handle string_type(std::size_t bytes) {
  Handle type(check(H5Tcopy(H5T_C_S1), "create type"), H5Tclose);
  check(H5Tset_size(type, bytes), "create type");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "create type");
  check(H5Tset_strpad(type, H5T_STR_NULLPAD), "create type");
  return type;
}

Handle text_type() {
  Handle type(check(H5Tcopy(H5T_C_S1), "create type"), H5Tclose);
  check(H5Tset_size(type, H5T_VARIABLE), "create type");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "create type");
  return type;
}

void write_attribute(hid_t object, const char* name, const std::string& text) {
  const Handle type = text_type();
  const Handle attribute(check(H5Acreate2(object, name, type, scalar_space(), H5P_DEFAULT, H5P_DEFAULT), name),
                         H5Aclose);
  const char* value = text.c_str();
  check(H5Awrite(attribute, type, &value), name);
}
void write_attribute(hid_t object, const char* name, std::span<const double> values) {
  write_numbers(object, name, H5T_NATIVE_DOUBLE, values.size(), values.data());
}
void write_attribute(hid_t object, const char* name, std::span<const int> values) {
  write_numbers(object, name, H5T_NATIVE_INT, values.size(), values.data());
}

std::string read_text_attribute(hid_t object, const char* name) {
  const Handle attribute(check(H5Aopen(object, name, H5P_DEFAULT), name), H5Aclose);
  char* text = nullptr;
  check(H5Aread(attribute, text_type(), &text), name);
  return take(text);
}
std::vector<double> read_double_attribute(hid_t object, const char* name) {
  return read_numbers<double>(object, name, H5T_NATIVE_DOUBLE);
}
std::vector<int> read_int_attribute(hid_t object, const char* name) {
  return read_numbers<int>(object, name, H5T_NATIVE_INT);
}

void write_array(hid_t parent, const char* name, hid_t type, std::span<const hsize_t> shape, const void* data) {
  const Handle space = simple_space(shape);
  const Handle set(check(H5Dcreate2(parent, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), name), H5Dclose);
  const bool empty = std::find(shape.begin(), shape.end(), hsize_t{0}) != shape.end();
  if (!empty) check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), name);
}

void write_texts(hid_t parent, const char* name, std::span<const std::string> texts) {
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  const hsize_t count = texts.size();
  write_array(parent, name, text_type(), {&count, 1}, pointers.data());
}

void write_text(hid_t parent, const char* name, const std::string& text) {
  const Handle type = text_type();
  const Handle set(check(H5Dcreate2(parent, name, type, scalar_space(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), name),
                   H5Dclose);
  const char* value = text.c_str();
  check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value), name);
}

std::vector<std::string> read_texts(hid_t parent, const char* name) {
  const Handle set = dataset(parent, name);
  std::vector<char*> pointers(extents(set).at(0), nullptr);
  if (!pointers.empty()) check(H5Dread(set, text_type(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()), name);
  std::vector<std::string> texts;
  for (char* pointer : pointers) texts.push_back(take(pointer));
  return texts;
}

std::string read_text(hid_t parent, const char* name) {
  const Handle set = dataset(parent, name);
  char* text = nullptr;
  check(H5Dread(set, text_type(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &text), name);
  return take(text);
}

Handle growing_dataset(hid_t parent, const char* name, hid_t type, std::span<const hsize_t> rest, hsize_t chunk_rows,
                       const void* fill) {
  std::vector<hsize_t> now{0}, most{H5S_UNLIMITED}, chunk{chunk_rows};
  for (const hsize_t extent : rest) {
    now.push_back(extent);
    most.push_back(extent);
    chunk.push_back(extent);
  }
  const Handle space(check(H5Screate_simple(static_cast<int>(now.size()), now.data(), most.data()), name), H5Sclose);
  const Handle properties(check(H5Pcreate(H5P_DATASET_CREATE), name), H5Pclose);
  check(H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data()), name);
  if (fill != nullptr) check(H5Pset_fill_value(properties, type, fill), name);
  return {check(H5Dcreate2(parent, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT), name), H5Dclose};
}

std::vector<hsize_t> extents(hid_t data) {
  const Handle space(check(H5Dget_space(data), "read extents"), H5Sclose);
  std::vector<hsize_t> shape(static_cast<std::size_t>(check(H5Sget_simple_extent_ndims(space), "read extents")));
  check(H5Sget_simple_extent_dims(space, shape.data(), nullptr), "read extents");
  return shape;
}

namespace {

/// File and memory dataspaces of some rows.
std::pair<Handle, Handle> select_rows(hid_t data, std::vector<hsize_t> shape, hsize_t first, hsize_t rows) {
  Handle file(check(H5Dget_space(data), "select rows"), H5Sclose);
  std::vector<hsize_t> start(shape.size(), 0);
  start[0] = first;
  shape[0] = rows;
  check(H5Sselect_hyperslab(file, H5S_SELECT_SET, start.data(), nullptr, shape.data(), nullptr), "select rows");
  return {std::move(file), simple_space(shape)};
}

}  // namespace

void append_rows(hid_t data, hid_t memory_type, hsize_t rows, const void* values) {
  if (rows == 0) return;
  std::vector<hsize_t> shape = extents(data);
  const hsize_t first = shape[0];
  shape[0] += rows;
  check(H5Dset_extent(data, shape.data()), "extend dataset");
  const auto [file, memory] = select_rows(data, shape, first, rows);
  check(H5Dwrite(data, memory_type, memory, file, H5P_DEFAULT, values), "write dataset");
}

void read_rows(hid_t data, hid_t memory_type, hsize_t first, hsize_t rows, void* values) {
  if (rows == 0) return;
  const auto [file, memory] = select_rows(data, extents(data), first, rows);
  check(H5Dread(data, memory_type, memory, file, H5P_DEFAULT, values), "read dataset");
}

}  // namespace stylet::h5
