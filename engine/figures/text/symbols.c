#include "engine/figures/text/symbols.h"
#include "engine/glint_figures.h"

#include <string.h>

#define SIGN(name, text, kind) { name, text, NULL, GLINT_ATOM_##kind, false, false }
#define PLAIN(name, text, plain, kind) { name, text, plain, GLINT_ATOM_##kind, false, false }
#define VARIABLE(name, text) { name, text, NULL, GLINT_ATOM_ORDINARY, true, false }
#define LARGE(name, text) { name, text, NULL, GLINT_ATOM_OPERATOR, false, true }

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
    PLAIN("ell", "\u2113", "l", ORDINARY), PLAIN("hbar", "\u210f", "h", ORDINARY),
    PLAIN("Re", "\u211c", "R", ORDINARY), PLAIN("Im", "\u2111", "I", ORDINARY), SIGN("aleph", "\u2135", ORDINARY),
    SIGN("wp", "\u2118", ORDINARY), PLAIN("imath", "\u0131", "i", ORDINARY),
    PLAIN("jmath", "\u0237", "j", ORDINARY), SIGN("prime", "\u2032", ORDINARY), SIGN("forall", "\u2200", ORDINARY),
    SIGN("exists", "\u2203", ORDINARY), SIGN("nexists", "\u2204", ORDINARY), SIGN("neg", "\u00ac", ORDINARY),
    SIGN("lnot", "\u00ac", ORDINARY), SIGN("emptyset", "\u2205", ORDINARY), SIGN("varnothing", "\u2205", ORDINARY),
    SIGN("top", "\u22a4", ORDINARY), SIGN("bot", "\u22a5", ORDINARY), SIGN("triangle", "\u25b3", ORDINARY),
    SIGN("square", "\u25a1", ORDINARY), SIGN("Box", "\u25a1", ORDINARY), SIGN("vdots", "\u22ee", ORDINARY),
    SIGN("surd", "\u221a", ORDINARY), SIGN("vert", "|", ORDINARY), SIGN("Vert", "\u2016", ORDINARY),
    SIGN("backslash", "\\", ORDINARY), SIGN("checkmark", "\u2713", ORDINARY),
    SIGN("ddots", "\u22f1", INNER), SIGN("dotsc", "\u2026", INNER), SIGN("dotsb", "\u22ef", INNER),
    PLAIN("mp", "\u2213", "-+", BINARY), SIGN("div", "\u00f7", BINARY), SIGN("ast", "\u2217", BINARY),
    PLAIN("star", "\u22c6", "*", BINARY), SIGN("bullet", "\u2022", BINARY), PLAIN("oplus", "\u2295", "(+)", BINARY),
    PLAIN("ominus", "\u2296", "(-)", BINARY), PLAIN("otimes", "\u2297", "(x)", BINARY),
    PLAIN("odot", "\u2299", "(.)", BINARY), PLAIN("cup", "\u222a", "U", BINARY), SIGN("cap", "\u2229", BINARY),
    PLAIN("setminus", "\u2216", "\\", BINARY), PLAIN("wedge", "\u2227", "^", BINARY),
    PLAIN("land", "\u2227", "^", BINARY), PLAIN("vee", "\u2228", "v", BINARY), PLAIN("lor", "\u2228", "v", BINARY),
    PLAIN("dagger", "\u2020", "+", BINARY), SIGN("ddagger", "\u2021", BINARY), SIGN("diamond", "\u22c4", BINARY),
    SIGN("bmod", "mod", BINARY),
    PLAIN("ll", "\u226a", "<<", RELATION), PLAIN("gg", "\u226b", ">>", RELATION),
    PLAIN("sim", "\u223c", "~", RELATION), PLAIN("simeq", "\u2243", "~", RELATION),
    SIGN("cong", "\u2245", RELATION), SIGN("equiv", "\u2261", RELATION), SIGN("doteq", "\u2250", RELATION),
    SIGN("asymp", "\u224d", RELATION), SIGN("prec", "\u227a", RELATION), SIGN("succ", "\u227b", RELATION),
    SIGN("lesssim", "\u2272", RELATION), SIGN("gtrsim", "\u2273", RELATION),
    PLAIN("leqslant", "\u2a7d", "\u2264", RELATION), PLAIN("geqslant", "\u2a7e", "\u2265", RELATION),
    SIGN("triangleq", "\u225c", RELATION), PLAIN("coloneqq", "\u2254", ":=", RELATION),
    PLAIN("mid", "\u2223", "|", RELATION), SIGN("nmid", "\u2224", RELATION), SIGN("subset", "\u2282", RELATION),
    SIGN("supset", "\u2283", RELATION), SIGN("subseteq", "\u2286", RELATION), SIGN("supseteq", "\u2287", RELATION),
    SIGN("subsetneq", "\u228a", RELATION), SIGN("notin", "\u2209", RELATION), SIGN("ni", "\u220b", RELATION),
    SIGN("models", "\u22a8", RELATION), SIGN("vdash", "\u22a2", RELATION), SIGN("lt", "<", RELATION),
    SIGN("gt", ">", RELATION), SIGN("rightarrow", "\u2192", RELATION), SIGN("leftarrow", "\u2190", RELATION),
    SIGN("gets", "\u2190", RELATION), PLAIN("leftrightarrow", "\u2194", "<->", RELATION),
    PLAIN("longrightarrow", "\u27f6", "\u2192", RELATION), PLAIN("longleftarrow", "\u27f5", "\u2190", RELATION),
    PLAIN("hookrightarrow", "\u21aa", "\u2192", RELATION), PLAIN("mapsto", "\u21a6", "\u2192", RELATION),
    SIGN("uparrow", "\u2191", RELATION), SIGN("downarrow", "\u2193", RELATION),
    PLAIN("Rightarrow", "\u21d2", "=>", RELATION), PLAIN("implies", "\u27f9", "=>", RELATION),
    PLAIN("Leftarrow", "\u21d0", "<=", RELATION), PLAIN("Leftrightarrow", "\u21d4", "<=>", RELATION),
    PLAIN("iff", "\u27fa", "<=>", RELATION), SIGN("therefore", "\u2234", RELATION),
    SIGN("because", "\u2235", RELATION),
    PLAIN("langle", "\u27e8", "<", OPENING), PLAIN("lfloor", "\u230a", "[", OPENING),
    PLAIN("lceil", "\u2308", "[", OPENING), SIGN("lvert", "|", OPENING), SIGN("lVert", "\u2016", OPENING),
    SIGN("lbrace", "{", OPENING), SIGN("lbrack", "[", OPENING),
    PLAIN("rangle", "\u27e9", ">", CLOSING), PLAIN("rfloor", "\u230b", "]", CLOSING),
    PLAIN("rceil", "\u2309", "]", CLOSING), SIGN("rvert", "|", CLOSING), SIGN("rVert", "\u2016", CLOSING),
    SIGN("rbrace", "}", CLOSING), SIGN("rbrack", "]", CLOSING),
    SIGN("colon", ":", PUNCTUATION),
    VARIABLE("varrho", "\u03f1"), VARIABLE("varsigma", "\u03c2"), VARIABLE("varpi", "\u03d6"),
    VARIABLE("varkappa", "\u03f0"), VARIABLE("omicron", "\u03bf"),
    LARGE("int", "\xe2\x88\xab"), // U+222B
    LARGE("sum", "\xe2\x88\x91"), // U+2211
    { "prod", "\u220f", "\u03a0", GLINT_ATOM_OPERATOR, false, true },
    LARGE("coprod", "\u2210"), LARGE("oint", "\u222e"), LARGE("iint", "\u222c"), LARGE("iiint", "\u222d"),
    LARGE("bigcup", "\u22c3"), LARGE("bigcap", "\u22c2"),
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
    SIGN("arctan", "arctan", OPERATOR), SIGN("sec", "sec", OPERATOR), SIGN("csc", "csc", OPERATOR),
    SIGN("cot", "cot", OPERATOR), SIGN("sinh", "sinh", OPERATOR), SIGN("cosh", "cosh", OPERATOR),
    SIGN("tanh", "tanh", OPERATOR), SIGN("coth", "coth", OPERATOR), SIGN("sup", "sup", OPERATOR),
    SIGN("inf", "inf", OPERATOR), SIGN("det", "det", OPERATOR), SIGN("dim", "dim", OPERATOR),
    SIGN("ker", "ker", OPERATOR), SIGN("gcd", "gcd", OPERATOR), SIGN("arg", "arg", OPERATOR),
    SIGN("deg", "deg", OPERATOR), SIGN("hom", "hom", OPERATOR), SIGN("lg", "lg", OPERATOR),
    SIGN("Pr", "Pr", OPERATOR), SIGN("limsup", "lim sup", OPERATOR), SIGN("liminf", "lim inf", OPERATOR),
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

const char *glint_formula_command(size_t index, const char **text, const char **kind)
{
    static const char *const kinds[] = { "ordinary", "operator", "binary", "relation", "opening", "closing", "punctuation", "inner" };
    if (index >= sizeof commands / sizeof *commands || !text || !kind)
        return NULL;
    const glint_symbol *symbol = &commands[index];
    *text = symbol->text;
    *kind = symbol->is_variable ? "variable" : symbol->is_large ? "large" : kinds[symbol->atom];
    return symbol->name;
}
