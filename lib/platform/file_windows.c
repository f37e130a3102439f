#include "platform/file.h"

#include "platform/status_windows.h"

#include <fcntl.h>
#include <io.h>
#include <stdlib.h>
#include <wchar.h>

#define MAX_TRANSFER ((size_t)1 << 30)
#define SHARE_ALL (FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE)
#define DESCRIPTOR_LIMIT 2048 /* limit of the C library, msvcrt.dll */

/* FileRenameInfoEx and FILE_RENAME_INFO, which headers declare for Windows 10 only. */
#define RENAME_INFO_EX ((FILE_INFO_BY_HANDLE_CLASS)22)
#define RENAME_REPLACE 1
#define RENAME_POSIX 2
struct rename {
    DWORD flags;
    HANDLE folder;
    DWORD name_size;
    WCHAR name[SLC_WIDE_PATH];
};

static const struct {
    DWORD error;
    int number;
} ERRORS[] = {
    {ERROR_FILE_NOT_FOUND, ENOENT},
    {ERROR_PATH_NOT_FOUND, ENOENT},
    {ERROR_BAD_NETPATH, ENOENT},
    {ERROR_BAD_NET_NAME, ENOENT},
    {ERROR_DEV_NOT_EXIST, ENOENT},
    {ERROR_DELETE_PENDING, ENOENT},
    {ERROR_INVALID_NAME, ENOENT},
    {ERROR_BAD_PATHNAME, ENOENT},
    {ERROR_INVALID_DRIVE, ENOENT},
    {ERROR_DIRECTORY, ENOTDIR},
    {ERROR_DIR_NOT_EMPTY, ENOTEMPTY},
    {ERROR_FILENAME_EXCED_RANGE, ENAMETOOLONG},
    {ERROR_BUFFER_OVERFLOW, ENAMETOOLONG}, /* "the file name is too long" */
    {ERROR_CANT_RESOLVE_FILENAME, ELOOP},
    {ERROR_ACCESS_DENIED, EACCES},
    {ERROR_NETWORK_ACCESS_DENIED, EACCES},
    {ERROR_SHARING_VIOLATION, EACCES},
    {ERROR_CANNOT_MAKE, EACCES},
    {ERROR_USER_MAPPED_FILE, EACCES},
    {ERROR_PRIVILEGE_NOT_HELD, EPERM},
    {ERROR_WRITE_PROTECT, EROFS},
    {ERROR_NOT_SAME_DEVICE, EXDEV},
    {ERROR_LOCK_VIOLATION, EWOULDBLOCK},
    {ERROR_IO_PENDING, EAGAIN},
    {ERROR_OPERATION_ABORTED, EINTR},
    {ERROR_TOO_MANY_OPEN_FILES, EMFILE},
    {ERROR_SHARING_BUFFER_EXCEEDED, ENFILE},
    {ERROR_NOT_ENOUGH_MEMORY, ENOMEM},
    {ERROR_OUTOFMEMORY, ENOMEM},
    {ERROR_NO_SYSTEM_RESOURCES, ENOMEM},
    {ERROR_NONPAGED_SYSTEM_RESOURCES, ENOMEM},
    {ERROR_PAGED_SYSTEM_RESOURCES, ENOMEM},
    {ERROR_WORKING_SET_QUOTA, ENOMEM},
    {ERROR_COMMITMENT_LIMIT, ENOMEM},
    {ERROR_NOT_ENOUGH_QUOTA, ENOMEM}, /* memory quota */
    {ERROR_FILE_EXISTS, EEXIST},
    {ERROR_ALREADY_EXISTS, EEXIST},
    {ERROR_DISK_FULL, ENOSPC},
    {ERROR_HANDLE_DISK_FULL, ENOSPC},
    {ERROR_FILE_TOO_LARGE, EFBIG},
    {ERROR_BROKEN_PIPE, EPIPE},
    {ERROR_NO_DATA, EPIPE},
    {ERROR_INVALID_PARAMETER, EINVAL},
    {ERROR_NEGATIVE_SEEK, EINVAL},
    {ERROR_INVALID_FUNCTION, EOPNOTSUPP},
    {ERROR_NOT_SUPPORTED, EOPNOTSUPP},
    {ERROR_NO_UNICODE_TRANSLATION, EILSEQ},
    {ERROR_INVALID_HANDLE, EBADF},
};

bool slc_fail_windows(void)
{
    DWORD error = GetLastError();
    errno = EIO;
    for (size_t i = 0; i < sizeof ERRORS / sizeof *ERRORS; i++)
        if (ERRORS[i].error == error)
            errno = ERRORS[i].number;
    return false;
}

bool slc_widen_path(const char *path, WCHAR wide[SLC_WIDE_PATH])
{
    if (MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, SLC_WIDE_PATH) > 0)
        return true;
    if (GetLastError() != ERROR_INSUFFICIENT_BUFFER)
        return slc_fail_windows();
    errno = ENAMETOOLONG;
    return false;
}

static HANDLE handle_of(int descriptor)
{
    return (HANDLE)_get_osfhandle(descriptor);
}

/* Returns the tag of a reparse point, opened without following; 0: not a reparse point. */
static DWORD reparse_tag(HANDLE handle)
{
    FILE_ATTRIBUTE_TAG_INFO info;
    return GetFileInformationByHandleEx(handle, FileAttributeTagInfo, &info, sizeof info) &&
                   (info.FileAttributes & FILE_ATTRIBUTE_REPARSE_POINT)
               ? info.ReparseTag
               : 0;
}

/* Opens a handle. Folders need FILE_FLAG_BACKUP_SEMANTICS, without effect for files. */
static HANDLE open_handle(const char *path, DWORD access, DWORD creation, DWORD flags)
{
    WCHAR wide[SLC_WIDE_PATH];
    if (!slc_widen_path(path, wide))
        return INVALID_HANDLE_VALUE;
    HANDLE handle = CreateFileW(wide, access, SHARE_ALL, NULL, creation,
                                FILE_FLAG_BACKUP_SEMANTICS | flags, NULL);
    if (handle == INVALID_HANDLE_VALUE)
        slc_fail_windows();
    return handle;
}

int slc_open_windows(const char *path, DWORD access, DWORD creation, DWORD flags, int mode)
{
    HANDLE handle = open_handle(path, access, creation, flags);
    if (handle == INVALID_HANDLE_VALUE)
        return -1;
    int descriptor = _open_osfhandle((intptr_t)handle, mode | _O_BINARY | _O_NOINHERIT);
    if (descriptor < 0) {
        CloseHandle(handle);
        errno = EMFILE;
    }
    return descriptor;
}

int slc_file_open(const char *path)
{
    return slc_open_windows(path, GENERIC_READ, OPEN_EXISTING, 0, _O_RDONLY);
}

static int create(const char *path, DWORD flags)
{
    return slc_open_windows(path, GENERIC_READ | GENERIC_WRITE, OPEN_ALWAYS, flags, _O_RDWR);
}

/* Windows has a bit for "read-only" alone, which a file that is being written does not need. */
int slc_file_create(const char *path, uint32_t permissions)
{
    (void)permissions;
    int descriptor = create(path, FILE_FLAG_OPEN_REPARSE_POINT);
    DWORD tag = descriptor < 0 ? 0 : reparse_tag(handle_of(descriptor));
    if (tag == 0)
        return descriptor;
    slc_file_close(descriptor);
    if (!IsReparseTagNameSurrogate(tag))
        return create(path, 0); /* opens through the driver that holds the contents */
    errno = ELOOP;
    return -1;
}

int slc_file_open_stream(const char *path)
{
    return slc_open_windows(path, GENERIC_WRITE, OPEN_EXISTING, 0, _O_WRONLY);
}

void slc_file_close(int descriptor)
{
    _close(descriptor);
}

uint64_t slc_get_descriptor_limit(void)
{
    return DESCRIPTOR_LIMIT;
}

/* Converts from units of 100 ns since 1601. */
static struct slc_file_time time_of(uint64_t time)
{
    uint64_t since_1970 = time - UINT64_C(116444736000000000);
    return (struct slc_file_time){(int64_t)(since_1970 / 10000000),
                                  (int64_t)(since_1970 % 10000000 * 100)};
}

static uint64_t join(DWORD high, DWORD low)
{
    return (uint64_t)high << 32 | low;
}

/* Returns the kind of a node. Reparse points of OneDrive and of deduplication are files. Links and
 * mounted folders refer to another name. */
static enum slc_node_kind kind_of(HANDLE handle, DWORD attributes)
{
    if ((attributes & FILE_ATTRIBUTE_REPARSE_POINT) &&
        IsReparseTagNameSurrogate(reparse_tag(handle)))
        return SLC_NODE_LINK;
    return attributes & FILE_ATTRIBUTE_DIRECTORY ? SLC_NODE_FOLDER : SLC_NODE_FILE;
}

bool slc_read_handle_status(HANDLE handle, struct slc_file_status *status)
{
    BY_HANDLE_FILE_INFORMATION info;
    FILE_BASIC_INFO basic;
    *status = (struct slc_file_status){.kind = SLC_NODE_STREAM, .permissions = 0666};
    DWORD type = GetFileType(handle);
    if (type == FILE_TYPE_CHAR || type == FILE_TYPE_PIPE)
        return true;
    if (!GetFileInformationByHandle(handle, &info) ||
        !GetFileInformationByHandleEx(handle, FileBasicInfo, &basic, sizeof basic))
        return slc_fail_windows();
    status->kind = kind_of(handle, info.dwFileAttributes);
    if (info.dwFileAttributes & FILE_ATTRIBUTE_READONLY)
        status->permissions = 0444;
    status->device = info.dwVolumeSerialNumber;
    status->inode = join(info.nFileIndexHigh, info.nFileIndexLow);
    status->link_count = info.nNumberOfLinks;
    status->size = join(info.nFileSizeHigh, info.nFileSizeLow);
    status->read = time_of((uint64_t)basic.LastAccessTime.QuadPart);
    status->modified = time_of((uint64_t)basic.LastWriteTime.QuadPart);
    status->changed = time_of((uint64_t)basic.ChangeTime.QuadPart);
    return true;
}

bool slc_file_get_status(int descriptor, struct slc_file_status *status)
{
    return slc_read_handle_status(handle_of(descriptor), status);
}

static bool get_path_status(const char *path, DWORD flags, struct slc_file_status *status)
{
    HANDLE handle = open_handle(path, FILE_READ_ATTRIBUTES, OPEN_EXISTING, flags);
    if (handle == INVALID_HANDLE_VALUE)
        return false;
    bool is_known = slc_read_handle_status(handle, status);
    CloseHandle(handle);
    return is_known;
}

bool slc_path_get_status(const char *path, struct slc_file_status *status)
{
    return get_path_status(path, 0, status);
}

bool slc_path_get_link_status(const char *path, struct slc_file_status *status)
{
    return get_path_status(path, FILE_FLAG_OPEN_REPARSE_POINT, status);
}

static DWORD at_once(size_t size)
{
    return (DWORD)(size < MAX_TRANSFER ? size : MAX_TRANSFER);
}

static OVERLAPPED place_of(uint64_t offset)
{
    return (OVERLAPPED){.Offset = (DWORD)offset, .OffsetHigh = (DWORD)(offset >> 32)};
}

int64_t slc_file_read_at(int descriptor, uint64_t offset, void *bytes, size_t size)
{
    OVERLAPPED place = place_of(offset);
    DWORD got = 0;
    if (ReadFile(handle_of(descriptor), bytes, at_once(size), &got, &place))
        return got;
    if (GetLastError() == ERROR_HANDLE_EOF)
        return 0;
    slc_fail_windows();
    return -1;
}

static int64_t write_bytes(int descriptor, const void *bytes, size_t size, OVERLAPPED *place)
{
    DWORD put = 0;
    if (WriteFile(handle_of(descriptor), bytes, at_once(size), &put, place))
        return put;
    slc_fail_windows();
    return -1;
}

int64_t slc_file_write_at(int descriptor, uint64_t offset, const void *bytes, size_t size)
{
    OVERLAPPED place = place_of(offset);
    return write_bytes(descriptor, bytes, size, &place);
}

int64_t slc_file_append(int descriptor, const void *bytes, size_t size)
{
    return write_bytes(descriptor, bytes, size, NULL);
}

/* Locks a byte beyond all files, because locks on Windows block reads of the locked bytes. */
bool slc_file_lock(int descriptor)
{
    OVERLAPPED place = place_of(UINT64_C(0x7FFFFFFFFFFFFFF0));
    return LockFileEx(handle_of(descriptor), LOCKFILE_EXCLUSIVE_LOCK | LOCKFILE_FAIL_IMMEDIATELY, 0,
                      1, 0, &place)
               ? true
               : slc_fail_windows();
}

bool slc_file_set_size(int descriptor, uint64_t size)
{
    FILE_END_OF_FILE_INFO end = {.EndOfFile = {.QuadPart = (LONGLONG)size}};
    return SetFileInformationByHandle(handle_of(descriptor), FileEndOfFileInfo, &end, sizeof end)
               ? true
               : slc_fail_windows();
}

bool slc_file_reserve(int descriptor, uint64_t size)
{
    FILE_ALLOCATION_INFO room = {.AllocationSize = {.QuadPart = (LONGLONG)size}};
    if (!SetFileInformationByHandle(handle_of(descriptor), FileAllocationInfo, &room,
                                    sizeof room) &&
        GetLastError() == ERROR_DISK_FULL)
        return slc_fail_windows();
    return slc_file_set_size(descriptor, size); /* room is not guaranteed on all file systems */
}

bool slc_file_sync(int descriptor)
{
    return FlushFileBuffers(handle_of(descriptor)) ? true : slc_fail_windows();
}

void slc_file_set_permissions(int descriptor, uint32_t permissions)
{
    (void)descriptor, (void)permissions; /* a new file inherits its folder's permissions */
}

const char *slc_path_name(const char *path)
{
    const char *name = path;
    for (const char *at = path; *at; at++)
        if (*at == '/' || *at == '\\' || *at == ':')
            name = at + 1;
    return name;
}

bool slc_path_is_writable(const char *path)
{
    struct slc_file_status status;
    if (!slc_path_get_status(path, &status))
        return false;
    errno = EACCES;
    return (status.permissions & 0222) != 0;
}

/* Renames with POSIX semantics (Windows 10 1607): open handles keep the old file.
 * FILE_FLAG_WRITE_THROUGH puts the name on the disk before the call returns. */
static bool replace_open(const char *from, const WCHAR *to)
{
    struct rename rename = {.flags = RENAME_REPLACE | RENAME_POSIX};
    DWORD length = GetFullPathNameW(to, SLC_WIDE_PATH, rename.name, NULL);
    if (length == 0 || length >= SLC_WIDE_PATH)
        return false;
    rename.name_size = length * (DWORD)sizeof *rename.name;
    HANDLE handle = open_handle(from, DELETE | SYNCHRONIZE, OPEN_EXISTING,
                                FILE_FLAG_OPEN_REPARSE_POINT | FILE_FLAG_WRITE_THROUGH);
    if (handle == INVALID_HANDLE_VALUE)
        return false;
    bool is_done = SetFileInformationByHandle(handle, RENAME_INFO_EX, &rename, sizeof rename);
    CloseHandle(handle);
    return is_done;
}

/* Replaces a file. The fallback is for older systems, and file systems without POSIX renames. */
bool slc_path_replace(const char *from, const char *to)
{
    WCHAR wide_from[SLC_WIDE_PATH], wide_to[SLC_WIDE_PATH];
    if (!slc_widen_path(from, wide_from) || !slc_widen_path(to, wide_to))
        return false;
    if (replace_open(from, wide_to))
        return true;
    return MoveFileExW(wide_from, wide_to, MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH)
               ? true
               : slc_fail_windows();
}

bool slc_path_remove(const char *path)
{
    WCHAR wide[SLC_WIDE_PATH];
    return slc_widen_path(path, wide) && (DeleteFileW(wide) || slc_fail_windows());
}

void slc_path_touch(const char *path)
{
    HANDLE handle = open_handle(path, FILE_WRITE_ATTRIBUTES, OPEN_EXISTING, 0);
    FILETIME now;
    if (handle == INVALID_HANDLE_VALUE)
        return;
    GetSystemTimeAsFileTime(&now);
    SetFileTime(handle, NULL, &now, NULL);
    CloseHandle(handle);
}

/* Converts "\\?\C:\a" to "C:\a" and "\\?\UNC\server\a" to "\\server\a", in place. */
static WCHAR *without_prefix(WCHAR *path)
{
    if (wcsncmp(path, L"\\\\?\\", 4) != 0)
        return path;
    if (wcsncmp(path + 4, L"UNC\\", 4) != 0)
        return path + 4;
    path[6] = L'\\';
    return path + 6;
}

static char *narrow(const WCHAR *wide)
{
    int size = WideCharToMultiByte(CP_UTF8, 0, wide, -1, NULL, 0, NULL, NULL);
    char *path = size > 0 ? malloc((size_t)size) : NULL;
    if (path)
        WideCharToMultiByte(CP_UTF8, 0, wide, -1, path, size, NULL, NULL);
    return path;
}

char *slc_path_resolve(const char *path)
{
    WCHAR full[SLC_WIDE_PATH];
    HANDLE handle = open_handle(path, 0, OPEN_EXISTING, 0);
    if (handle == INVALID_HANDLE_VALUE)
        return NULL;
    DWORD length = GetFinalPathNameByHandleW(handle, full, SLC_WIDE_PATH, 0);
    if (length == 0)
        slc_fail_windows();
    else if (length >= SLC_WIDE_PATH)
        errno = ENAMETOOLONG;
    CloseHandle(handle);
    return length > 0 && length < SLC_WIDE_PATH ? narrow(without_prefix(full)) : NULL;
}

uint64_t slc_get_process_id(void)
{
    return GetCurrentProcessId();
}
