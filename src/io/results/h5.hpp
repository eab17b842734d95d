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

/// A thin layer over the HDF5 C library: handles that close themselves and errors with the library's own reason.
/// Functions here throw h5::Failure; the files that use them catch it at their own border.
namespace stylet::h5 {

/// What HDF5 refused, with the innermost reason it gave.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A thread's turn with HDF5, which is not safe for several at once (Debian builds it so): others wait for as long as
/// it lives. Nor does HDF5 print to stderr meanwhile. Turns may be nested.
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

/// Passes a good status or identifier through; throws Failure("action: reason") for a bad one.
template <class Status>
Status check(Status status, const char* action);
[[noreturn]] void fail(const char* action);

template <class Status>
Status check(Status status, const char* action) {
  if (status < 0) fail(action);
  return status;
}

/// An identifier and the call that closes it.
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

  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): stands for the identifier
  /// Closes now; returns false when HDF5 reports that closing (hence the last writing) failed.
  bool reset() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

/// Creates a file in the latest format, in which everything but raw data has a checksum. An existing one is replaced.
/// Neither it nor what is made in it says when that was: the same content gives the same bytes.
Handle create_file(const char* path);
/// Opens a file to read it that another process may be writing (SWMR), or was when it was killed. A wrong checksum may
/// be of a block that is half written, so HDF5 reads it again, for a seventh of a second at most.
Handle open_growing_file(const char* path);
bool has_attribute(hid_t object, const char* name);

Handle group(hid_t parent, const char* name);  ///< created
Handle open_group(hid_t parent, const char* name);
Handle dataset(hid_t parent, const char* name);  ///< opened
Handle array_type(hid_t element, hsize_t count);
Handle string_type(std::size_t bytes);  ///< fixed length, UTF-8, null-padded

/// Attributes. Text is a scalar; numbers are 1-D arrays. All text is written with a fixed length: HDF5 keeps text of
/// variable length where no checksum sees it change, and crashes when it has. Read is either.
void write_attribute(hid_t object, const char* name, const std::string& text);
void write_attribute(hid_t object, const char* name, std::span<const double> values);
void write_attribute(hid_t object, const char* name, std::span<const int> values);
std::string read_text_attribute(hid_t object, const char* name);
std::vector<double> read_double_attribute(hid_t object, const char* name);
std::vector<int> read_int_attribute(hid_t object, const char* name);

/// Datasets of fixed size, written once.
void write_texts(hid_t parent, const char* name, std::span<const std::string> texts);
/// A table of texts: rows of named columns.
/// @param rows each with as many texts as there are columns
void write_text_table(hid_t parent, const char* name, std::span<const char* const> columns,
                      std::span<const std::vector<std::string>> rows);
void write_text(hid_t parent, const char* name, const std::string& text);
/// @param data null where its values will be written later (write_rows())
void write_array(hid_t parent, const char* name, hid_t type, std::span<const hsize_t> shape, const void* data);
std::vector<std::string> read_texts(hid_t parent, const char* name);
std::vector<std::string> read_text_column(hid_t parent, const char* name, const char* column);
std::string read_text(hid_t parent, const char* name);

/// Creates an empty dataset that grows along its first axis.
/// @param rest extents of the other axes
/// @param chunk_rows rows per chunk
/// @param fill value of rows that exist but have not reached the disk, in `type`; may be null (zeros)
Handle growing_dataset(hid_t parent, const char* name, hid_t type, std::span<const hsize_t> rest, hsize_t chunk_rows,
                       const void* fill);

/// Extents of an open dataset.
std::vector<hsize_t> extents(hid_t data);

/// Where in its file the values of a dataset begin that was written whole; 0 where it has none.
std::uint64_t place(hid_t data);
/// [bytes] of one of its values in the file.
std::size_t item_bytes(hid_t data);

/// Writes `rows` rows behind the last of a growing dataset.
void append_rows(hid_t data, hid_t memory_type, hsize_t rows, const void* values);

/// Writes rows first … first + rows - 1, which are there.
void write_rows(hid_t data, hid_t memory_type, hsize_t first, hsize_t rows, const void* values);

/// Reads rows first … first + rows - 1.
void read_rows(hid_t data, hid_t memory_type, hsize_t first, hsize_t rows, void* values);

}  // namespace stylet::h5
