#include "engine/text/symbols.h"

#include <string.h>

#define SIGN(name, text, kind) { name, text, GLINT_ATOM_##kind, false, false }
#define VARIABLE(name, text) { name, text, GLINT_ATOM_ORDINARY, true, false }
#define LARGE(name, text) { name, text, GLINT_ATOM_OPERATOR, false, true }

static const glint_symbol commands[] = {
    VARIABLE("alpha", "\xce\xb1"), // U+03B1
    VARIABLE("beta", "\xce\xb2"), // U+03B2
    VARIABLE("gamma", "\xce\xb3"), // U+03B3
    VARIABLE("delta", "\xce\xb4"), // U+03B4
    VARIABLE("epsilon", "\xcf\xb5"), // U+03F5
    VARIABLE("varepsilon", "\xce\xb5"), // U+03B5
    VARIABLE("zeta", "\xce\xb6"), // U+03B6
    VARIABLE("eta", "\xce\xb7"), // U+03B7
    VARIABLE("theta", "\xce\xb8"), // U+03B8
    VARIABLE("vartheta", "\xcf\x91"), // U+03D1
    VARIABLE("iota", "\xce\xb9"), // U+03B9
    VARIABLE("kappa", "\xce\xba"), // U+03BA
    VARIABLE("lambda", "\xce\xbb"), // U+03BB
    VARIABLE("mu", "\xce\xbc"), // U+03BC
    VARIABLE("nu", "\xce\xbd"), // U+03BD
    VARIABLE("xi", "\xce\xbe"), // U+03BE
    VARIABLE("pi", "\xcf\x80"), // U+03C0
    VARIABLE("rho", "\xcf\x81"), // U+03C1
    VARIABLE("sigma", "\xcf\x83"), // U+03C3
    VARIABLE("tau", "\xcf\x84"), // U+03C4
    VARIABLE("upsilon", "\xcf\x85"), // U+03C5
    VARIABLE("phi", "\xcf\x95"), // U+03D5
    VARIABLE("varphi", "\xcf\x86"), // U+03C6
    VARIABLE("chi", "\xcf\x87"), // U+03C7
    VARIABLE("psi", "\xcf\x88"), // U+03C8
    VARIABLE("omega", "\xcf\x89"), // U+03C9
    SIGN("Gamma", "\xce\x93", ORDINARY), // U+0393
    SIGN("Delta", "\xce\x94", ORDINARY), // U+0394
    SIGN("Theta", "\xce\x98", ORDINARY), // U+0398
    SIGN("Lambda", "\xce\x9b", ORDINARY), // U+039B
    SIGN("Xi", "\xce\x9e", ORDINARY), // U+039E
    SIGN("Pi", "\xce\xa0", ORDINARY), // U+03A0
    SIGN("Sigma", "\xce\xa3", ORDINARY), // U+03A3
    SIGN("Upsilon", "\xce\xa5", ORDINARY), // U+03A5
    SIGN("Phi", "\xce\xa6", ORDINARY), // U+03A6
    SIGN("Psi", "\xce\xa8", ORDINARY), // U+03A8
    SIGN("Omega", "\xce\xa9", ORDINARY), // U+03A9
    SIGN("infty", "\xe2\x88\x9e", ORDINARY), // U+221E
    SIGN("partial", "\xe2\x88\x82", ORDINARY), // U+2202
    SIGN("nabla", "\xe2\x88\x87", ORDINARY), // U+2207
    SIGN("degree", "\xc2\xb0", ORDINARY), // U+00B0
    SIGN("angle", "\xe2\x88\xa0", ORDINARY), // U+2220
    SIGN("dots", "\xe2\x80\xa6", INNER), // U+2026
    SIGN("ldots", "\xe2\x80\xa6", INNER), // U+2026
    SIGN("cdots", "\xe2\x8b\xaf", INNER), // U+22EF
    SIGN("|", "\xe2\x80\x96", ORDINARY), // U+2016
    SIGN("{", "{", OPENING),
    SIGN("}", "}", CLOSING),
    SIGN("$", "$", ORDINARY),
    SIGN("%", "%", ORDINARY),
    SIGN("#", "#", ORDINARY),
    SIGN("&", "&", ORDINARY),
    SIGN("_", "_", ORDINARY),
    SIGN("cdot", "\xc2\xb7", BINARY), // U+00B7
    SIGN("times", "\xc3\x97", BINARY), // U+00D7
    SIGN("pm", "\xc2\xb1", BINARY), // U+00B1
    SIGN("circ", "\xe2\x88\x98", BINARY), // U+2218
    SIGN("le", "\xe2\x89\xa4", RELATION), // U+2264
    SIGN("leq", "\xe2\x89\xa4", RELATION), // U+2264
    SIGN("ge", "\xe2\x89\xa5", RELATION), // U+2265
    SIGN("geq", "\xe2\x89\xa5", RELATION), // U+2265
    SIGN("ne", "\xe2\x89\xa0", RELATION), // U+2260
    SIGN("neq", "\xe2\x89\xa0", RELATION), // U+2260
    SIGN("approx", "\xe2\x89\x88", RELATION), // U+2248
    SIGN("propto", "\xe2\x88\x9d", RELATION), // U+221D
    SIGN("to", "\xe2\x86\x92", RELATION), // U+2192
    SIGN("in", "\xe2\x88\x88", RELATION), // U+2208
    SIGN("perp", "\xe2\x8a\xa5", RELATION), // U+22A5
    SIGN("parallel", "\xe2\x88\xa5", RELATION), // U+2225
    LARGE("int", "\xe2\x88\xab"), // U+222B
    LARGE("sum", "\xe2\x88\x91"), // U+2211
    SIGN("cos", "cos", OPERATOR),
    SIGN("sin", "sin", OPERATOR),
    SIGN("tan", "tan", OPERATOR),
    SIGN("arccos", "arccos", OPERATOR),
    SIGN("arcsin", "arcsin", OPERATOR),
    SIGN("log", "log", OPERATOR),
    SIGN("ln", "ln", OPERATOR),
    SIGN("exp", "exp", OPERATOR),
    SIGN("max", "max", OPERATOR),
    SIGN("min", "min", OPERATOR),
    SIGN("lim", "lim", OPERATOR),
};

static const glint_symbol signs[] = {
    SIGN("/", "/", ORDINARY),
    SIGN(".", ".", ORDINARY),
    SIGN("|", "|", ORDINARY),
    SIGN("'", "\xe2\x80\xb2", ORDINARY), // U+2032
    SIGN("+", "+", BINARY),
    SIGN("-", "\xe2\x88\x92", BINARY), // U+2212
    SIGN("*", "\xe2\x88\x97", BINARY), // U+2217
    SIGN("=", "=", RELATION),
    SIGN("<", "<", RELATION),
    SIGN(">", ">", RELATION),
    SIGN(":", ":", RELATION),
    SIGN("(", "(", OPENING),
    SIGN("[", "[", OPENING),
    SIGN(")", ")", CLOSING),
    SIGN("]", "]", CLOSING),
    SIGN("!", "!", CLOSING),
    SIGN("?", "?", CLOSING),
    SIGN(",", ",", PUNCTUATION),
    SIGN(";", ";", PUNCTUATION),
};

bool glint_symbol_is(const char *known, const char *name, size_t size)
{
    return strncmp(known, name, size) == 0 && known[size] == '\0';
}

const glint_symbol *glint_symbol_find(bool is_command, const char *name, size_t size)
{
    const glint_symbol *symbols = is_command ? commands : signs;
    const size_t count = is_command ? sizeof commands / sizeof *commands : sizeof signs / sizeof *signs;
    for (size_t i = 0; i < count; i++)
        if (glint_symbol_is(symbols[i].name, name, size))
            return &symbols[i];
    for (size_t i = 0; i < sizeof commands / sizeof *commands && !is_command; i++)
        if (glint_symbol_is(commands[i].text, name, size)) // the character itself: a Greek letter or a mathematical sign
            return &commands[i];
    return NULL;
}
