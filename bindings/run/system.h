/// Functions that operating systems have under different names, or not at all. Each uses Linux's function there and a portable
/// one elsewhere (macOS, the BSDs); GLINT_PORTABLE, from `make PORTABLE=1`, takes the portable one on Linux, too, for tests.
#ifndef GLINT_L_SYSTEM_H
#define GLINT_L_SYSTEM_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <sys/socket.h>
#include <time.h>

#ifndef MSG_NOSIGNAL
#define MSG_NOSIGNAL 0 // then the sockets made here have SO_NOSIGPIPE
#endif

/// Wakes a thread that polls. {0} is not open.
typedef struct glintL_wake {
    int from; ///< to poll for POLLIN
    int to;
} glintL_wake;

/// False: errno says why.
bool glintL_wake_open(glintL_wake *wake);
void glintL_wake_close(glintL_wake *wake); ///< does nothing unless open
void glintL_wake_call(const glintL_wake *wake); ///< from any thread, any number of times
void glintL_wake_clear(const glintL_wake *wake); ///< after poll: calls up to now are taken

/// Sockets that no other program inherits and that never raise SIGPIPE; neither end blocks. -1: errno says why.
int glintL_socket(int domain, int type);
int glintL_accept(int listener);
/// Two ends joined; these block. False: errno says why.
bool glintL_socket_pair(int ends[2]);

/// A condition that is waited for until a time of GLINTL_COND_CLOCK, which no setting of the date moves where there is such.
void glintL_cond_init(pthread_cond_t *cond);
#if defined(__linux__) && !defined(GLINT_PORTABLE)
#define GLINTL_COND_CLOCK CLOCK_MONOTONIC
#else
#define GLINTL_COND_CLOCK CLOCK_REALTIME
#endif

/// Bytes that cannot be guessed. False: there are none to be had.
bool glintL_random(void *bytes, size_t size);

/// Numbers of this thread keep their points, whatever locale is set later (not on NetBSD, whose locales belong to processes).
void glintL_keep_points(void);

/// The folder of the program that runs, "/usr/bin/", links followed; `started_as` is its argv[0]. False: it cannot be told.
bool glintL_program_folder(const char *started_as, char *folder, size_t size);

/// Returns the kind of a path that is not a file to be read from beginning to end: "device", "pipe", "socket" or "folder". NULL: it
/// is one, or nothing is there. Does not wait for the other end of a pipe, which opening it would.
const char *glintL_other_kind(const char *path);

/// The most memory that this process has had at a time, bytes.
long long glintL_peak_bytes(void);

/// The processor's model, or its kind where the system does not tell.
void glintL_processor_name(char out[128]);

#endif
