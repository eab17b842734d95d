// SPDX-License-Identifier: GPL-3.0-or-later
#include "h5_new_file.hpp"

#include "detail/disk.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <new>
#include <system_error>
#include <tuple>

namespace stylet::h5 {

namespace {

/// A file as HDF5's drivers see it.
struct Disk : H5FD_t {
  int file = -1;
  dev_t device = 0;
  ino_t number = 0;
  haddr_t allocated = 0;  ///< end of what HDF5 has given to its objects
  haddr_t size = 0;
  std::shared_ptr<int> reason;                        ///< NewFile::reason_
  std::vector<std::pair<haddr_t, std::string>> kept;  ///< what could not be written, in order
};

/// The settings that the access properties of a file hand to its driver.
struct DriverSettings {
  const std::shared_ptr<int>* reason = nullptr;
};

Disk& disk_of(H5FD_t* file) { return *static_cast<Disk*>(file); }
const Disk& disk_of(const H5FD_t* file) { return *static_cast<const Disk*>(file); }

H5FD_t* open_disk(const char* name, unsigned flags, hid_t access, haddr_t /*most*/) {
  int how = (flags & H5F_ACC_RDWR) != 0 ? O_RDWR : O_RDONLY;
  if ((flags & H5F_ACC_TRUNC) != 0) how |= O_TRUNC;
  if ((flags & H5F_ACC_CREAT) != 0) how |= O_CREAT;
  if ((flags & H5F_ACC_EXCL) != 0) how |= O_EXCL;
  const auto* settings = static_cast<const DriverSettings*>(H5Pget_driver_info(access));
  const int file = settings == nullptr ? -1 : ::open(name, how | O_CLOEXEC, 0666);
  struct stat about {};
  auto* disk = file >= 0 && ::fstat(file, &about) == 0 ? new (std::nothrow) Disk{} : nullptr;
  if (disk == nullptr) {
    if (file >= 0) ::close(file);
    return nullptr;
  }
  disk->file = file;
  disk->device = about.st_dev;
  disk->number = about.st_ino;
  disk->size = static_cast<haddr_t>(about.st_size);
  disk->reason = *settings->reason;
  return disk;
}

herr_t close_disk(H5FD_t* file) {
  Disk* const disk = &disk_of(file);
  if (::close(disk->file) != 0 && *disk->reason == 0) *disk->reason = errno;
  delete disk;
  return 0;
}

int compare_disks(const H5FD_t* a, const H5FD_t* b) {
  const auto key = [](const Disk& disk) { return std::tuple(disk.device, disk.number); };
  if (key(disk_of(a)) == key(disk_of(b))) return 0;
  return key(disk_of(a)) < key(disk_of(b)) ? -1 : 1;
}

/// The features of HDF5's own driver of files, so that the same content gives the same bytes.
herr_t features_of_disk(const H5FD_t* /*file*/, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_SUPPORTS_SWMR_IO | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t allocated_on_disk(const H5FD_t* file, H5FD_mem_t /*type*/) { return disk_of(file).allocated; }
herr_t allocate_on_disk(H5FD_t* file, H5FD_mem_t /*type*/, haddr_t end) {
  disk_of(file).allocated = end;
  return 0;
}
haddr_t size_on_disk(const H5FD_t* file, H5FD_mem_t /*type*/) { return disk_of(file).size; }

herr_t read_disk(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t at, std::size_t size, void* buffer) {
  const Disk& disk = disk_of(file);
  char* const to = static_cast<char*>(buffer);
  std::size_t have = 0;
  while (have < size) {
    const ssize_t read = ::pread(disk.file, to + have, size - have, static_cast<off_t>(at + have));
    if (read < 0 && errno != EINTR) return -1;
    if (read == 0) break;
    if (read > 0) have += static_cast<std::size_t>(read);
  }
  std::memset(to + have, 0, size - have);
  for (const auto& [start, bytes] : disk.kept) {
    const haddr_t first = std::max(at, start), last = std::min<haddr_t>(at + size, start + bytes.size());
    if (first < last) std::memcpy(to + (first - at), bytes.data() + (first - start), last - first);
  }
  return 0;
}

int write_to(int file, haddr_t at, const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::pwrite(file, bytes, size, static_cast<off_t>(at));
    if (written < 0 && errno != EINTR) return errno;
    if (written <= 0) continue;
    at += static_cast<haddr_t>(written);
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
  return 0;
}

herr_t write_disk(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t at, std::size_t size,
                  const void* buffer) {
  Disk& disk = disk_of(file);
  const char* const bytes = static_cast<const char*>(buffer);
  if (*disk.reason == 0) *disk.reason = write_to(disk.file, at, bytes, size);
  if (*disk.reason != 0) {
    try {
      disk.kept.emplace_back(at, std::string(bytes, size));
    } catch (const std::bad_alloc&) {
      return -1;
    }
  }
  disk.size = std::max(disk.size, at + size);
  return 0;
}

herr_t truncate_disk(H5FD_t* file, hid_t /*transfer*/, hbool_t /*closing*/) {
  Disk& disk = disk_of(file);
  if (disk.size == disk.allocated) return 0;
  if (*disk.reason == 0 && ::ftruncate(disk.file, static_cast<off_t>(disk.allocated)) != 0) *disk.reason = errno;
  disk.size = disk.allocated;
  return 0;
}

/// Only for a driver with these calls does HDF5 mark the file as being written, which its readers require. The file
/// needs no lock, since nobody else knows its hidden name.
herr_t lock_disk(H5FD_t* /*file*/, hbool_t /*alone*/) { return 0; }
herr_t unlock_disk(H5FD_t* /*file*/) { return 0; }

hid_t driver() {
  static const H5FD_class_t about{.name = "stylet_new_file",
                                  .maxaddr = std::numeric_limits<off_t>::max(),
                                  .fc_degree = H5F_CLOSE_WEAK,
                                  .fapl_size = sizeof(DriverSettings),
                                  .open = open_disk,
                                  .close = close_disk,
                                  .cmp = compare_disks,
                                  .query = features_of_disk,
                                  .get_eoa = allocated_on_disk,
                                  .set_eoa = allocate_on_disk,
                                  .get_eof = size_on_disk,
                                  .read = read_disk,
                                  .write = write_disk,
                                  .truncate = truncate_disk,
                                  .lock = lock_disk,
                                  .unlock = unlock_disk,
                                  .fl_map = H5FD_FLMAP_DICHOTOMY};
  static const hid_t id = check(H5FDregister(&about), "create file");
  return id;
}

}  // namespace

NewFile::NewFile(const char* path) : reason_(std::make_shared<int>(0)) {
  const Handle access(h5::check(H5Pcreate(H5P_FILE_ACCESS), "create file"), H5Pclose);
  h5::check(H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST), "create file");
  const DriverSettings settings{&reason_};
  h5::check(H5Pset_driver(access, driver(), &settings), "create file");
  const Handle creation(h5::check(H5Pcreate(H5P_FILE_CREATE), "create file"), H5Pclose);
  h5::check(H5Pset_obj_track_times(creation, false), "create file");
  file_ = {h5::check(H5Fcreate(path, H5F_ACC_TRUNC, creation, access), "create file"), H5Fclose};
}

void NewFile::check() const {
  if (reason_ && *reason_ != 0) throw std::system_error(*reason_, std::generic_category());
}

void NewFile::close() {
  const bool closed = file_.reset();
  check();
  if (!closed) fail("close");
}

Result<> written(const std::filesystem::path& path, const std::function<void()>& write) {
  const LibraryTurn turn;
  try {
    write();
    return Ok{};
  } catch (const std::system_error& e) {
    return detail::write_error(path, e.code().value());
  } catch (const std::runtime_error& e) {  // of HDF5
    return failure(path.string(), std::string("cannot be written: ") + e.what(), "Choose another folder");
  }
}

}  // namespace stylet::h5
