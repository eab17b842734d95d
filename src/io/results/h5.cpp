// SPDX-License-Identifier: GPL-3.0-or-later
#include "h5.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

namespace stylet::h5 {

namespace {

/// Takes the number of the system's error from an entry of HDF5's error stack, which names it as "errno = 28".
herr_t take_number(unsigned, const H5E_error2_t* entry, void* to) {
  constexpr std::string_view kSign = "errno = ";
  const std::string_view words = entry->desc != nullptr ? entry->desc : "";
  const auto at = words.find(kSign);
  if (at != std::string_view::npos)
    (void)std::from_chars(words.data() + at + kSign.size(), words.data() + words.size(), *static_cast<int*>(to));
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

/// Copies a text from memory that HDF5 allocated, and frees that memory.
std::string take(char* text) {
  std::string copy = text == nullptr ? "" : text;
  if (text != nullptr) H5free_memory(text);
  return copy;
}

/// Concatenates texts, each padded with zeros to a fixed length.
std::string side_by_side(std::span<const std::string> texts, std::size_t width) {
  std::string all(texts.size() * width, '\0');
  for (std::size_t k = 0; k < texts.size(); ++k) texts[k].copy(all.data() + k * width, width);
  return all;
}

std::vector<std::string> taken_apart(const std::string& all, std::size_t width) {
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < all.size(); at += width) {
    const std::string padded = all.substr(at, width);
    texts.push_back(padded.substr(0, padded.find_last_not_of('\0') + 1));
  }
  return texts;
}

/// The length of the longest text, but at least 1, since HDF5 does not support texts of length zero.
std::size_t width_of(std::span<const std::string> texts) {
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, text.size());
  return width;
}

/// Reads texts of fixed or variable length.
/// @param type type of one text in the file
/// @param read function that reads into memory: its arguments are the type in memory and the address
template <class Read>
std::vector<std::string> texts_of(hid_t type, std::size_t count, const Read& read) {
  std::vector<std::string> texts;
  if (count == 0) return texts;
  if (check(H5Tis_variable_str(type), "read text") > 0) {
    std::vector<char*> pointers(count, nullptr);
    read(type, pointers.data());
    for (char* pointer : pointers) texts.push_back(take(pointer));
    return texts;
  }
  if (H5Tget_class(type) != H5T_STRING) throw Failure("read text: it is not a text");
  const std::size_t width = H5Tget_size(type);
  if (width == 0 || count > std::string().max_size() / width) throw Failure("read text: it has the wrong shape");
  std::string all(count * width, '\0');
  read(type, all.data());
  return taken_apart(all, width);
}

/// Throws if a dataspace does not have the expected number of elements; closes it.
void expect_elements(Handle space, std::size_t count, const char* name) {
  if (static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space), name)) != count)
    throw Failure(std::string(name) + ": has the wrong shape");
}

/// A compound type with only one of the columns.
Handle column_type(const char* column, hid_t type) {
  Handle rows(check(H5Tcreate(H5T_COMPOUND, H5Tget_size(type)), "create type"), H5Tclose);
  check(H5Tinsert(rows, column, 0, type), column);
  return rows;
}

/// Creation properties of an object without time stamps.
Handle timeless(hid_t kind) {
  Handle properties(check(H5Pcreate(kind), "create"), H5Pclose);
  check(H5Pset_obj_track_times(properties, false), "create");
  return properties;
}

}  // namespace

Failure::Failure(const char* action, int number)
    : std::runtime_error(number != 0 ? std::generic_category().message(number) + " (" + action + ")"
                                     : "damaged or incomplete (" + std::string(action) + ")") {}

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
/// Silences HDF5 at the end of the program. HDF5 1.10 leaks an object whose checksum is wrong, and would print
/// "infinite loop closing library" when it shuts down.
struct SilentEnd {
  SilentEnd() = default;
  ~SilentEnd() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }
  SilentEnd(const SilentEnd&) = delete;
  SilentEnd& operator=(const SilentEnd&) = delete;
};
}  // namespace

void fail(const char* action) {
  static const SilentEnd before_that_of_hdf5;  // destroyed before HDF5 shuts down, which was initialised earlier
  int number = 0;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_number, &number);
  throw Failure(action, number);
}

Handle open_growing_file(const char* path) {
  // The first wait is 1 ns and each further one twice as long: 28 attempts take 0.13 s; HDF5's default of 100 attempts
  // would never end.
  constexpr unsigned kAttempts = 28;
  const Handle access(check(H5Pcreate(H5P_FILE_ACCESS), "open"), H5Pclose);
  check(H5Pset_metadata_read_attempts(access, kAttempts), "open");
  return {check(H5Fopen(path, H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access), "open"), H5Fclose};
}

bool has_attribute(hid_t object, const char* name) { return check(H5Aexists(object, name), name) > 0; }
Handle group(hid_t parent, const char* name) {
  return {check(H5Gcreate2(parent, name, H5P_DEFAULT, timeless(H5P_GROUP_CREATE), H5P_DEFAULT), name), H5Gclose};
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

Handle enum_type(int count, const char* (*name)(int value)) {
  Handle type(check(H5Tenum_create(H5T_NATIVE_INT8), "create type"), H5Tclose);
  for (std::int8_t value = 0; value < count; ++value) check(H5Tenum_insert(type, name(value), &value), "create type");
  return type;
}

Handle bool_type() {
  return enum_type(2, [](int value) { return value == 0 ? "FALSE" : "TRUE"; });
}

Handle compound_type(std::size_t bytes) { return {check(H5Tcreate(H5T_COMPOUND, bytes), "create type"), H5Tclose}; }

void insert_member(hid_t compound, const char* name, std::size_t offset, hid_t member) {
  check(H5Tinsert(compound, name, offset, member), name);
}

void write_attribute(hid_t object, const char* name, const std::string& text) {
  const std::size_t width = width_of({&text, 1});
  const Handle type = string_type(width);
  const Handle attribute(check(H5Acreate2(object, name, type, scalar_space(), H5P_DEFAULT, H5P_DEFAULT), name),
                         H5Aclose);
  check(H5Awrite(attribute, type, side_by_side({&text, 1}, width).data()), name);
}
void write_attribute(hid_t object, const char* name, std::span<const double> values) {
  write_numbers(object, name, H5T_NATIVE_DOUBLE, values.size(), values.data());
}
void write_attribute(hid_t object, const char* name, std::span<const int> values) {
  write_numbers(object, name, H5T_NATIVE_INT, values.size(), values.data());
}

std::string read_text_attribute(hid_t object, const char* name) {
  const Handle attribute(check(H5Aopen(object, name, H5P_DEFAULT), name), H5Aclose);
  const Handle type(check(H5Aget_type(attribute), name), H5Tclose);
  expect_elements({check(H5Aget_space(attribute), name), H5Sclose}, 1, name);
  return texts_of(type, 1, [&](hid_t memory, void* to) { check(H5Aread(attribute, memory, to), name); }).front();
}
std::vector<double> read_double_attribute(hid_t object, const char* name) {
  return read_numbers<double>(object, name, H5T_NATIVE_DOUBLE);
}
std::vector<int> read_int_attribute(hid_t object, const char* name) {
  return read_numbers<int>(object, name, H5T_NATIVE_INT);
}

void write_array(hid_t parent, const char* name, hid_t type, std::span<const hsize_t> shape, const void* data) {
  const Handle space = simple_space(shape);
  const Handle set(
      check(H5Dcreate2(parent, name, type, space, H5P_DEFAULT, timeless(H5P_DATASET_CREATE), H5P_DEFAULT), name),
      H5Dclose);
  const bool empty = std::find(shape.begin(), shape.end(), hsize_t{0}) != shape.end();
  if (!empty && data != nullptr) check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), name);
}

void write_texts(hid_t parent, const char* name, std::span<const std::string> texts) {
  const std::size_t width = width_of(texts);
  const hsize_t count = texts.size();
  write_array(parent, name, string_type(width), {&count, 1}, side_by_side(texts, width).data());
}

void write_text(hid_t parent, const char* name, const std::string& text) {
  const std::size_t width = width_of({&text, 1});
  const Handle type = string_type(width);
  const Handle set(
      check(H5Dcreate2(parent, name, type, scalar_space(), H5P_DEFAULT, timeless(H5P_DATASET_CREATE), H5P_DEFAULT),
            name),
      H5Dclose);
  check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, side_by_side({&text, 1}, width).data()), name);
}

void write_text_table(hid_t parent, const char* name, std::span<const char* const> columns,
                      std::span<const std::vector<std::string>> rows) {
  std::vector<std::string> column(rows.size());
  std::vector<std::size_t> widths;
  std::size_t row_bytes = 0;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::transform(rows.begin(), rows.end(), column.begin(), [&](const auto& row) { return row.at(c); });
    widths.push_back(width_of(column));
    row_bytes += widths.back();
  }
  const Handle type(check(H5Tcreate(H5T_COMPOUND, row_bytes), name), H5Tclose);
  std::string all;
  for (std::size_t c = 0, at = 0; c < columns.size(); at += widths[c++])
    check(H5Tinsert(type, columns[c], at, string_type(widths[c])), name);
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < columns.size(); ++c) all += side_by_side({&row[c], 1}, widths[c]);
  }
  const hsize_t count = rows.size();
  write_array(parent, name, type, {&count, 1}, all.data());
}

std::vector<std::string> read_texts(hid_t parent, const char* name) {
  const Handle set = dataset(parent, name);
  const Handle type(check(H5Dget_type(set), name), H5Tclose);
  const std::size_t count = extents(set).at(0);
  expect_elements({check(H5Dget_space(set), name), H5Sclose}, count, name);
  return texts_of(type, count, [&](hid_t memory, void* to) {
    check(H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, to), name);
  });
}

std::vector<std::string> read_text_column(hid_t parent, const char* name, const char* column) {
  const Handle set = dataset(parent, name);
  const Handle rows(check(H5Dget_type(set), name), H5Tclose);
  const auto member = static_cast<unsigned>(check(H5Tget_member_index(rows, column), column));
  const Handle type(check(H5Tget_member_type(rows, member), column), H5Tclose);
  const std::size_t count = extents(set).at(0);
  expect_elements({check(H5Dget_space(set), name), H5Sclose}, count, name);
  return texts_of(type, count, [&](hid_t memory, void* to) {
    check(H5Dread(set, column_type(column, memory), H5S_ALL, H5S_ALL, H5P_DEFAULT, to), name);
  });
}

std::string read_text(hid_t parent, const char* name) {
  const Handle set = dataset(parent, name);
  const Handle type(check(H5Dget_type(set), name), H5Tclose);
  expect_elements({check(H5Dget_space(set), name), H5Sclose}, 1, name);
  return texts_of(type, 1,
                  [&](hid_t memory, void* to) { check(H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, to), name); })
      .front();
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
  const Handle properties = timeless(H5P_DATASET_CREATE);
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

bool has_member(hid_t data, const char* name) {
  const Handle rows(check(H5Dget_type(data), "read type"), H5Tclose);
  return H5Tget_class(rows) == H5T_COMPOUND && H5Tget_member_index(rows, name) >= 0;
}

std::uint64_t place(hid_t data) {
  const haddr_t at = H5Dget_offset(data);
  return at == HADDR_UNDEF ? 0 : at;
}

std::size_t item_bytes(hid_t data) { return H5Tget_size(Handle(check(H5Dget_type(data), "read type"), H5Tclose)); }

namespace {

/// The dataspaces in file and memory that select some rows.
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
  write_rows(data, memory_type, first, rows, values);
}

void write_rows(hid_t data, hid_t memory_type, hsize_t first, hsize_t rows, const void* values) {
  if (rows == 0) return;
  const auto [file, memory] = select_rows(data, extents(data), first, rows);
  check(H5Dwrite(data, memory_type, memory, file, H5P_DEFAULT, values), "write dataset");
}

void read_rows(hid_t data, hid_t memory_type, hsize_t first, hsize_t rows, std::span<std::byte> values) {
  if (rows == 0) return;
  const std::vector<hsize_t> shape = extents(data);
  // Divided step by step: the product of the extents of a forged file can be beyond 64 bits.
  hsize_t room = values.size() / H5Tget_size(memory_type) / rows;
  for (std::size_t axis = 1; axis < shape.size(); ++axis) {
    if (shape[axis] == 0) return;
    room /= shape[axis];
  }
  if (shape.empty() || room == 0) throw Failure("a dataset has the wrong shape");
  const auto [file, memory] = select_rows(data, shape, first, rows);
  check(H5Dread(data, memory_type, memory, file, H5P_DEFAULT, values.data()), "read dataset");
}

}  // namespace stylet::h5
