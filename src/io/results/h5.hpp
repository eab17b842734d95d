// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// A thin layer over the HDF5 C library: handles that close themselves, and errors that name the part of the file. The
/// functions throw h5::Failure; their callers in this folder catch it.
namespace stylet::h5 {

/// Exception for an error of HDF5, in words of our own.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
  /// @param action the part of the file, or what was done with it
  /// @param number errno of the system's call that failed; 0: none did, so the file's content is at fault
  Failure(const char* action, int number);
};

/// Exclusive access of a thread to HDF5, which is not thread-safe (as Debian builds it): other threads wait during the
/// lifetime of this object. HDF5 does not print to stderr during that time. Objects may be nested.
class LibraryTurn {
 public:
  LibraryTurn();
  ~LibraryTurn();
  LibraryTurn(const LibraryTurn&) = delete;
  LibraryTurn& operator=(const LibraryTurn&) = delete;

 private:
  std::unique_lock<std::recursive_mutex> alone_;
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Returns a valid status or identifier unchanged; throws Failure for an invalid one.
template <class Status>
Status check(Status status, const char* action);
[[noreturn]] void fail(const char* action);

template <class Status>
Status check(Status status, const char* action) {
  if (status < 0) fail(action);
  return status;
}

/// An identifier and the call that closes it; null: it is not closed.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { reset(); }

  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): is used as the identifier
  /// Closes the object; returns false if HDF5 reports that closing, and therefore the last writing, failed.
  bool reset() { return id_ < 0 || close_ == nullptr || close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

/// Opens a file for reading that another process may be writing (SWMR), or was writing when it was killed. Since a
/// wrong checksum may belong to a block that is being written, HDF5 repeats reading for at most a seventh of a second.
Handle open_growing_file(const char* path);
bool has_attribute(hid_t object, const char* name);

Handle group(hid_t parent, const char* name);  ///< creates a group
Handle open_group(hid_t parent, const char* name);
Handle dataset(hid_t parent, const char* name);  ///< opens a dataset
Handle array_type(hid_t element, hsize_t count);
Handle string_type(std::size_t bytes);  ///< fixed length, UTF-8, null-padded
Handle bool_type();                     ///< the enumeration of one byte that h5py reads as bool
Handle compound_type(std::size_t bytes);
/// An enumeration of one byte with the values 0 … count − 1.
Handle enum_type(int count, const char* (*name)(int value));
inline hid_t number_type(double) { return H5T_NATIVE_DOUBLE; }
inline hid_t number_type(float) { return H5T_NATIVE_FLOAT; }
inline hid_t number_type(std::int64_t) { return H5T_NATIVE_INT64; }
inline hid_t number_type(std::int32_t) { return H5T_NATIVE_INT32; }
inline hid_t number_type(std::uint32_t) { return H5T_NATIVE_UINT32; }
inline hid_t number_type(char) { return H5T_NATIVE_UINT8; }
void insert_member(hid_t compound, const char* name, std::size_t offset, hid_t member);

/// Attributes: texts are scalars, numbers are 1-D arrays. All texts are written with a fixed length, because HDF5
/// stores texts of variable length without a checksum and crashes if they are damaged. Both kinds can be read.
void write_attribute(hid_t object, const char* name, const std::string& text);
void write_attribute(hid_t object, const char* name, std::span<const double> values);
void write_attribute(hid_t object, const char* name, std::span<const int> values);
std::string read_text_attribute(hid_t object, const char* name);
std::vector<double> read_double_attribute(hid_t object, const char* name);
std::vector<int> read_int_attribute(hid_t object, const char* name);

/// Datasets of fixed size, written once.
void write_texts(hid_t parent, const char* name, std::span<const std::string> texts);
/// A table of texts: rows of named columns.
/// @param rows each with one text per column
void write_text_table(hid_t parent, const char* name, std::span<const char* const> columns,
                      std::span<const std::vector<std::string>> rows);
void write_text(hid_t parent, const char* name, const std::string& text);
/// Writes an array. @param data null if its values will be written later by write_rows()
void write_array(hid_t parent, const char* name, hid_t type, std::span<const hsize_t> shape, const void* data);
std::vector<std::string> read_texts(hid_t parent, const char* name);
std::vector<std::string> read_text_column(hid_t parent, const char* name, const char* column);
std::string read_text(hid_t parent, const char* name);

/// Creates an empty dataset that grows along its first axis.
/// @param rest extents of the other axes
/// @param chunk_rows rows per chunk
/// @param fill value, of type `type`, of rows that exist but have not reached the disk; may be null (zeros)
Handle growing_dataset(hid_t parent, const char* name, hid_t type, std::span<const hsize_t> rest, hsize_t chunk_rows,
                       const void* fill);

/// Extents of an open dataset.
std::vector<hsize_t> extents(hid_t data);

/// Whether the rows of an open dataset have a column.
bool has_member(hid_t data, const char* name);

/// Position in the file of the values of a contiguous dataset; 0 if it has no values.
std::uint64_t place(hid_t data);
/// Size of a dataset's value in the file [bytes].
std::size_t item_bytes(hid_t data);

/// Appends `rows` rows to a growing dataset.
void append_rows(hid_t data, hid_t memory_type, hsize_t rows, const void* values);

/// Writes the existing rows first … first + rows - 1.
void write_rows(hid_t data, hid_t memory_type, hsize_t first, hsize_t rows, const void* values);

/// Reads the rows first … first + rows - 1. Throws Failure if they do not fit into `values`, whatever shape the file
/// states.
void read_rows(hid_t data, hid_t memory_type, hsize_t first, hsize_t rows, std::span<std::byte> values);

}  // namespace stylet::h5
