// glint._unpack: reads files compressed by gzip or zstd, like a file of io.open. Only for scripts/lib.
#include <stdio.h>
#include <string.h>
#include <zlib.h>

#include "bindings/lua/lua.h"
#include "bindings/run/system.h"

#ifdef GLINT_HAVE_ZSTD
#include <zstd.h>
#endif

#define PACKED "glint.packed"
#define CHUNK 65536
#define READ_MAX (1 << 26) // bytes
#define GZIP "compressed by gzip, and broken"
#define ZSTD "compressed by zstd, and broken"

typedef struct packed {
    gzFile gzip; // NULL: zstd, or closed
    lua_Integer at; // position in the text
#ifdef GLINT_HAVE_ZSTD
    FILE *file;
    ZSTD_DStream *stream;
    ZSTD_inBuffer in;
    size_t expects; // 0 at the end of a frame
    char bytes[CHUNK];
#endif
} packed;

// Reads up to `size` bytes. Returns their number; less at the end. -1: the file is broken.
static int read_bytes(packed *p, char *out, unsigned size)
{
    int got = 0;
    if (p->gzip) {
        int code;
        got = gzread(p->gzip, out, size);
        gzerror(p->gzip, &code);
        if (code != Z_OK && code != Z_STREAM_END) // also a file that ends early
            return -1;
    }
#ifdef GLINT_HAVE_ZSTD
    ZSTD_outBuffer to = { out, size, 0 };
    while (p->stream && to.pos < size) {
        if (p->in.pos == p->in.size) {
            p->in = (ZSTD_inBuffer) { p->bytes, fread(p->bytes, 1, CHUNK, p->file), 0 };
            if (p->in.size == 0 && (p->expects > 0 || ferror(p->file)))
                return -1;
            if (p->in.size == 0)
                break;
        }
        p->expects = ZSTD_decompressStream(p->stream, &to, &p->in);
        if (ZSTD_isError(p->expects))
            return -1;
    }
    if (p->stream)
        got = (int)to.pos;
#endif
    p->at += got > 0 ? got : 0;
    return got;
}

static int close_packed(lua_State *L)
{
    packed *p = luaL_checkudata(L, 1, PACKED);
    if (p->gzip)
        gzclose(p->gzip);
    p->gzip = NULL;
#ifdef GLINT_HAVE_ZSTD
    ZSTD_freeDStream(p->stream);
    p->stream = NULL;
    if (p->file)
        fclose(p->file);
    p->file = NULL;
#endif
    return 0;
}

// read(n): returns n bytes, less at the end, then nil; nil and a message if the file is broken.
static int read_text(lua_State *L)
{
    luaL_Buffer out;
    packed *p = luaL_checkudata(L, 1, PACKED);
    lua_Integer size = luaL_checkinteger(L, 2);
    size = size < 1 ? 1 : size < READ_MAX ? size : READ_MAX;
    const int got = read_bytes(p, luaL_buffinitsize(L, &out, (size_t)size), (unsigned)size);
    if (got > 0) {
        luaL_pushresultsize(&out, (size_t)got);
        return 1;
    }
    lua_pushnil(L);
    lua_pushstring(L, got == 0 ? NULL : p->gzip ? GZIP : ZSTD);
    return 2;
}

// seek("set", position)
static int seek(lua_State *L)
{
    char skipped[4096];
    packed *p = luaL_checkudata(L, 1, PACKED);
    const lua_Integer to = luaL_checkinteger(L, 3);
    if (to < p->at) {
        p->at = 0;
        if (p->gzip)
            gzrewind(p->gzip);
#ifdef GLINT_HAVE_ZSTD
        if (p->stream) {
            rewind(p->file);
            ZSTD_initDStream(p->stream);
            p->in.pos = p->in.size = p->expects = 0;
        }
#endif
    }
    while (p->at < to) {
        const lua_Integer left = to - p->at;
        if (read_bytes(p, skipped, (unsigned)(left < (lua_Integer)sizeof skipped ? left : (lua_Integer)sizeof skipped)) <= 0)
            break;
    }
    return 0;
}

// _unpack(path, method): "gzip" or "zstd".
static int unpack(lua_State *L)
{
    static const char *const methods[] = { "gzip", "zstd", NULL };
    const char *path = luaL_checkstring(L, 1);
    const int method = luaL_checkoption(L, 2, NULL, methods);
    if (glintL_get_run(L)->request.is_untrusted)
        return glintL_error(L, "an untrusted script reads no files");
    if (glintL_other_kind(path))
        return glintL_error(L, "%s: a file expected, got a %s", path, glintL_other_kind(path));
    packed *p = lua_newuserdatauv(L, sizeof *p, 0);
    memset(p, 0, sizeof *p);
    luaL_setmetatable(L, PACKED);
    bool good = false;
    if (method == 0)
        good = (p->gzip = gzopen(path, "rb")) != NULL;
#ifdef GLINT_HAVE_ZSTD
    else
        good = (p->file = fopen(path, "rb")) && (p->stream = ZSTD_createDStream()) && !ZSTD_isError(ZSTD_initDStream(p->stream));
#else
    else
        return glintL_error(L, "%s: is compressed by zstd, which this build does not read", path);
#endif
    return good ? 1 : glintL_error(L, "%s: cannot be read", path);
}

void glintL_open_unpack(lua_State *L)
{
    static const luaL_Reg methods[] = { { "read", read_text }, { "seek", seek }, { "close", close_packed }, { NULL, NULL } };
    luaL_newmetatable(L, PACKED);
    glintL_set_function(L, "__gc", close_packed);
    luaL_newlib(L, methods);
    lua_setfield(L, -2, "__index");
    lua_pop(L, 1);
    glintL_set_function(L, "_unpack", unpack);
}
