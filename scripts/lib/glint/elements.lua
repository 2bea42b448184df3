-- The elements: number, colour, van der Waals and covalent radius.
--     local elements = require "glint.elements"
--     elements.O.color, elements.O.radius, elements.symbol "CL"  -->  "#ff0d0d"  1.52  "Cl"
-- Colours: the CPK-derived scheme of Jmol (Jmol's documentation, "Jmol colors"), sRGB; none from 110 on.
-- Radii, angstroms: A. Bondi, J. Phys. Chem. 68 (1964) 441, and for the main-group elements missing there M. Mantina et
-- al., J. Phys. Chem. A 113 (2009) 5806. Elements in neither have `radius` = 2 and `guessed` = true. Covalent radii,
-- angstroms: B. Cordero et al., Dalton Trans. (2008) 2832; C is sp3; Mn, Fe and Co are low spin. From Bk on there are
-- none: `covalent` is 1.7.
local elements = {}

local SYMBOLS = [[
H He Li Be B C N O F Ne Na Mg Al Si P S Cl Ar
K Ca Sc Ti V Cr Mn Fe Co Ni Cu Zn Ga Ge As Se Br Kr
Rb Sr Y Zr Nb Mo Tc Ru Rh Pd Ag Cd In Sn Sb Te I Xe Cs Ba
La Ce Pr Nd Pm Sm Eu Gd Tb Dy Ho Er Tm Yb Lu Hf Ta W Re Os Ir Pt Au Hg Tl Pb Bi Po At Rn
Fr Ra Ac Th Pa U Np Pu Am Cm Bk Cf Es Fm Md No Lr Rf Db Sg Bh Hs Mt]]

local COLORS = [[
ffffff d9ffff cc80ff c2ff00 ffb5b5 909090 3050f8 ff0d0d 90e050 b3e3f5
ab5cf2 8aff00 bfa6a6 f0c8a0 ff8000 ffff30 1ff01f
80d1e3 8f40d4 3dff00 e6e6e6 bfc2c7 a6a6ab 8a99c7 9c7ac7 e06633 f090a0 50d050 c88033 7d80b0 c28f8f 668f8f bd80e3 ffa100
a62929 5cb8d1 702eb0 00ff00 94ffff 94e0e0 73c2c9 54b5b5 3b9e9e 248f8f 0a7d8c 006985 c0c0c0 ffd98f a67573 668080 9e63b5
d47a00 940094 429eb0 57178f 00c900 70d4ff ffffc7 d9ffc7 c7ffc7 a3ffc7 8fffc7 61ffc7 45ffc7 30ffc7 1fffc7 00ff9c 00e675
00d452 00bf38 00ab24 4dc2ff 4da6ff 2194d6 267dab 266696 175487 d0d0e0 ffd123 b8b8d0 a6544d 575961 9e4fb5 ab5c00 754f45
428296 420066 007d00 70abfa 00baff 00a1ff 008fff 0080ff 006bff 545cf2 785ce3 8a4fe3 a136d4 b31fd4 b31fba b30da6 bd0d87
c70066 cc0059 d1004f d90045 e00038 e6002e eb0026]]

local BONDI = {
  H = 1.20, He = 1.40, Li = 1.82, C = 1.70, N = 1.55, O = 1.52, F = 1.47, Ne = 1.54, Na = 2.27, Mg = 1.73, Si = 2.10,
  P = 1.80, S = 1.80, Cl = 1.75, Ar = 1.88, K = 2.75, Ni = 1.63, Cu = 1.40, Zn = 1.39, Ga = 1.87, As = 1.85, Se = 1.90,
  Br = 1.85, Kr = 2.02, Pd = 1.63, Ag = 1.72, Cd = 1.58, In = 1.93, Sn = 2.17, Te = 2.06, I = 1.98, Xe = 2.16,
  Pt = 1.75, Au = 1.66, Hg = 1.55, Tl = 1.96, Pb = 2.02, U = 1.86,
}

local MANTINA = {
  Be = 1.53, B = 1.92, Al = 1.84, Ca = 2.31, Ge = 2.11, Rb = 3.03, Sr = 2.49, Sb = 2.06, Cs = 3.43, Ba = 2.68,
  Bi = 2.07, Po = 1.97, At = 2.02, Rn = 2.20, Fr = 3.48, Ra = 2.83,
}

-- By atomic number.
local CORDERO = [[
0.31 0.28 1.28 0.96 0.84 0.76 0.71 0.66 0.57 0.58 1.66 1.41 1.21 1.11 1.07 1.05 1.02 1.06
2.03 1.76 1.70 1.60 1.53 1.39 1.39 1.32 1.26 1.24 1.32 1.22 1.22 1.20 1.19 1.20 1.20 1.16
2.20 1.95 1.90 1.75 1.64 1.54 1.47 1.46 1.42 1.39 1.45 1.44 1.42 1.39 1.39 1.38 1.39 1.40 2.44 2.15
2.07 2.04 2.03 2.01 1.99 1.98 1.98 1.96 1.94 1.92 1.92 1.89 1.90 1.87 1.87
1.75 1.70 1.62 1.51 1.44 1.41 1.36 1.36 1.32 1.45 1.46 1.48 1.40 1.50 1.50
2.60 2.21 2.15 2.06 2.00 1.96 1.90 1.87 1.80 1.69]]

local GUESSED_RADIUS, GUESSED_COVALENT = 2, 1.7

local by_number = {}
local next_color, next_covalent = COLORS:gmatch "%x+", CORDERO:gmatch "%S+"
for symbol in SYMBOLS:gmatch "%a+" do
  local radius = BONDI[symbol] or MANTINA[symbol]
  by_number[#by_number + 1] = symbol
  elements[symbol] = {
    number = #by_number, color = "#" .. next_color(), radius = radius or GUESSED_RADIUS, guessed = not radius,
    covalent = tonumber(next_covalent() or GUESSED_COVALENT),
  }
end

--- Returns the symbol as usually written ("Cl") for a symbol in any case or an atomic number; D and T are hydrogen. nil
--- if there is no such element.
---@param label string
function elements.symbol(label)
  local number = math.tointeger(tonumber(label))
  if number then return by_number[number] end
  local symbol = label:sub(1, 1):upper() .. label:sub(2):lower()
  if symbol == "D" or symbol == "T" then return "H" end
  return type(elements[symbol]) == "table" and symbol or nil
end

-- Symbols that usually belong to other atoms when more characters follow: CD1 is a carbon.
local NAMES = { CA = "C", CD = "C", CE = "C", CF = "C", CM = "C", HE = "H", HF = "H", HG = "H", HO = "H", HS = "H",
  NB = "N", ND = "N", NE = "N", NO = "N", NP = "N", OS = "O", PA = "P", SG = "S" }

-- Labels of sites without an atom, which would otherwise be read as elements.
local SITES = { BQ = true, DA = true, DU = true, DUM = true, TV = true, VC = true, VS = true, VAC = true }

--- Returns the symbol at the beginning of a label: of an atom with a number or charge (C13, Fe+3, O2-, 13C), a position
--- (CB, HG11, OW) or a force-field type (C_R, C.ar). nil for labels of no element, such as ghost atoms (Xx, Bq, EP).
---@param label string
function elements.of_label(label)
  local symbol = elements.symbol(label)
  if symbol then return symbol end
  local letters = label:match "^%d*(%a+)"
  local capitals = letters and letters:upper()
  if not letters or #letters > 3 or SITES[capitals] or label:find "[Bb][Qq]$" or label:find ":$" then return nil end
  local two = letters:sub(1, 2)
  if #two == 2 and (not NAMES[two:upper()] or two:find "^%u%l") then symbol = elements.symbol(two) end
  return symbol or elements.symbol(letters:sub(1, 1))
end

return elements
