/* A library that gives a program its device, at the socket of `ramtek serve --unix`:
   cc -shared -fPIC -o ramtek_device.so examples/ramtek_device.c -ldl
   RAMTEK_DEVICE=/dev/ramtek RAMTEK_SOCKET=/tmp/display LD_PRELOAD=$PWD/ramtek_device.so old_program
   Opening RAMTEK_DEVICE connects to RAMTEK_SOCKET. As the drivers of the time did, a write is rounded down to whole
   words, and a read, rounded down too, returns when all its bytes have come. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#define NEXT(result, name, ...) ((result (*)(__VA_ARGS__)) dlsym(RTLD_NEXT, name))
enum { MOST_BYTES = 1 << 16 }; /* The longest packet of the display has 64 KiB. */
static const char MARK[] = "\0ramtek"; /* Our sockets have names that begin so: dup and exec keep them. */
static char rest[MOST_BYTES]; /* The bytes of a packet that the program has not read. */
static size_t rest_begin, rest_end;

static int is_device(int file)
{
    struct sockaddr_un own = {0};
    socklen_t length = sizeof own;
    int before = errno, fails = getsockname(file, (struct sockaddr *) &own, &length);
    errno = before;
    return !fails && own.sun_family == AF_UNIX && !memcmp(own.sun_path, MARK, sizeof MARK - 1);
}

static int connected(void)
{
    struct sockaddr_un own = {.sun_family = AF_UNIX}, display = own;
    int number = 0, file = socket(AF_UNIX, SOCK_SEQPACKET, 0);
    strncpy(display.sun_path, getenv("RAMTEK_SOCKET") ?: "", sizeof display.sun_path - 1);
    do
        snprintf(own.sun_path + 1, sizeof own.sun_path - 1, "%s %d %d", MARK + 1, getpid(), number++);
    while (bind(file, (struct sockaddr *) &own, sizeof own) && errno == EADDRINUSE);
    rest_begin = rest_end = 0;
    if (!connect(file, (struct sockaddr *) &display, sizeof display))
        return file;
    number = errno;
    close(file);
    errno = number;
    return -1;
}

static int opened(const char *call, int folder, const char *path, int flags, va_list more)
{
    const char *device = getenv("RAMTEK_DEVICE");
    mode_t mode = flags & O_CREAT || (flags & O_TMPFILE) == O_TMPFILE ? va_arg(more, mode_t) : 0;
    if (device && path && !strcmp(path, device))
        return connected();
    return NEXT(int, call, int, const char *, int, ...)(folder, path, flags, mode);
}

/* Relative to the current folder, openat does what open does. */
#define OPEN(name, call, folder, ...) int name(__VA_ARGS__ const char *path, int flags, ...) \
{ \
    va_list more; \
    va_start(more, flags); \
    int file = opened(call, folder, path, flags, more); \
    va_end(more); \
    return file; \
}
#define FOLDER int folder,
OPEN(open, "openat", AT_FDCWD,)
OPEN(open64, "openat64", AT_FDCWD,)
OPEN(openat, "openat", folder, FOLDER)
OPEN(openat64, "openat64", folder, FOLDER)
int creat(const char *path, mode_t mode) { return open(path, O_CREAT | O_WRONLY | O_TRUNC, mode); }
int creat64(const char *path, mode_t mode) { return open64(path, O_CREAT | O_WRONLY | O_TRUNC, mode); }
/* A program that was compiled with _FORTIFY_SOURCE calls these, and __read_chk below. */
int __open_2(const char *path, int flags) { return open(path, flags); }
int __open64_2(const char *path, int flags) { return open64(path, flags); }
int __openat_2(int folder, const char *path, int flags) { return openat(folder, path, flags); }
int __openat64_2(int folder, const char *path, int flags) { return openat64(folder, path, flags); }

ssize_t write(int file, const void *data, size_t count)
{
    if (!is_device(file))
        return NEXT(ssize_t, "write", int, const void *, size_t)(file, data, count);
    for (size_t done = 0, whole = count & ~(size_t) 1; done < whole; done += MOST_BYTES)
        if (send(file, (const char *) data + done, whole - done < MOST_BYTES ? whole - done : MOST_BYTES, MSG_NOSIGNAL) < 0)
            return -1;
    return (ssize_t) count;
}

ssize_t read(int file, void *data, size_t count)
{
    size_t done = 0;
    if (!is_device(file))
        return NEXT(ssize_t, "read", int, void *, size_t)(file, data, count);
    for (count &= ~(size_t) 1; done < count;) {
        if (rest_begin == rest_end) {
            ssize_t length = recv(file, rest, sizeof rest, 0);
            if (length <= 0)
                return done ? (ssize_t) done : length;
            rest_begin = 0;
            rest_end = (size_t) length;
        }
        size_t part = rest_end - rest_begin < count - done ? rest_end - rest_begin : count - done;
        memcpy((char *) data + done, rest + rest_begin, part);
        rest_begin += part;
        done += part;
    }
    return (ssize_t) done;
}

ssize_t __read_chk(int file, void *data, size_t count, size_t room)
{
    return read(file, data, count < room ? count : room);
}
