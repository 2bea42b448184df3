/// Functions that operating systems have under different names, or not at all. On Linux they use its own function,
/// elsewhere (macOS, the BSDs) a portable one. GLINT_PORTABLE, set by `make PORTABLE=1`, uses the portable ones on
/// Linux too, for tests.
#ifndef GLINT_L_SYSTEM_H
#define GLINT_L_SYSTEM_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <sys/socket.h>
#include <time.h>

#ifndef MSG_NOSIGNAL
#define MSG_NOSIGNAL 0 // the sockets made here have SO_NOSIGPIPE instead
#endif

/// A descriptor that wakes a polling thread. {0} is not open.
typedef struct glintL_wake {
    int from; ///< poll it for POLLIN
    int to;
} glintL_wake;

/// False: errno gives the reason.
bool glintL_wake_open(glintL_wake *wake);
void glintL_wake_close(glintL_wake *wake); ///< no effect unless open
void glintL_wake_call(const glintL_wake *wake); ///< from any thread, any number of times
void glintL_wake_clear(const glintL_wake *wake); ///< call after poll: clears all calls so far

/// Make sockets that child processes do not inherit and that never raise SIGPIPE or block. -1: errno gives the reason.
int glintL_socket(int domain, int type);
int glintL_accept(int listener);
/// Makes two connected, blocking sockets. False: errno gives the reason.
bool glintL_socket_pair(int ends[2]);

/// Makes a condition for timed waits on the clock GLINTL_COND_CLOCK, which is not affected by setting the date if the
/// system has such a clock.
void glintL_cond_init(pthread_cond_t *cond);
#if defined(__linux__) && !defined(GLINT_PORTABLE)
#define GLINTL_COND_CLOCK CLOCK_MONOTONIC
#else
#define GLINTL_COND_CLOCK CLOCK_REALTIME
#endif

/// Fills unpredictable bytes. False: none are available.
bool glintL_random(void *bytes, size_t size);

/// Makes a folder and its parents. False: there is no such folder afterwards, and errno says why.
bool glintL_make_folders(const char *folder);

/// Keeps the decimal point in numbers of this thread, whatever locale is set later (except on NetBSD, where locales
/// belong to processes).
void glintL_keep_points(void);

/// Finds the folder of the running program, "/usr/bin/", with links resolved; `started_as` is its argv[0]. False: not
/// found.
bool glintL_program_folder(const char *started_as, char *folder, size_t size);

/// Returns "device", "pipe", "socket" or "folder" for a path that is not a regular file. NULL: it is one, or does not
/// exist. Does not block on a pipe, unlike opening it.
const char *glintL_other_kind(const char *path);

/// Returns the peak memory of this process, bytes.
long long glintL_peak_bytes(void);

/// Writes the processor's model, or its architecture if the system does not provide the model.
void glintL_processor_name(char out[128]);

#endif
