//! The names of instructions.
//!
//! One mnemonic covers several forms in the table: `ADD` exists on three units, with registers, constants and 40-bit
//! operands. With the operands in the assembler's order, all forms of a mnemonic compute the same.

use std::fmt;

/// Passes all mnemonics to the macro `$m`.
#[macro_export]
macro_rules! for_each_mnemonic {
    ($m:ident) => {
        $m! {
            /// Absolute value, saturating.
            Abs = ABS;
            /// Sum, wrapping.
            Add = ADD;
            /// Unsigned sum into 40 bits.
            Addu = ADDU;
            /// Sum of singles.
            Addsp = ADDSP;
            /// Sum of doubles.
            Adddp = ADDDP;
            /// Bits set in both.
            And = AND;
            /// 1 if equal, else 0.
            Cmpeq = CMPEQ;
            /// 1 if greater, signed.
            Cmpgt = CMPGT;
            /// 1 if greater, unsigned.
            Cmpgtu = CMPGTU;
            /// 1 if less, signed.
            Cmplt = CMPLT;
            /// 1 if less, unsigned.
            Cmpltu = CMPLTU;
            /// Double to integer, nearest.
            Dpint = DPINT;
            /// Double to single.
            Dpsp = DPSP;
            /// Double to integer, toward zero.
            Dptrunc = DPTRUNC;
            /// Signed integer to double.
            Intdp = INTDP;
            /// Unsigned integer to double.
            Intdpu = INTDPU;
            /// Signed integer to single.
            Intsp = INTSP;
            /// Unsigned integer to single.
            Intspu = INTSPU;
            /// Place of the leftmost bit of a value.
            Lmbd = LMBD;
            /// Number of redundant sign bits.
            Norm = NORM;
            /// Bits set in one or both.
            Or = OR;
            /// Sum, saturating.
            Sadd = SADD;
            /// 40 bits to 32, saturating.
            Sat = SAT;
            /// Single to integer, nearest.
            Spint = SPINT;
            /// Single to integer, toward zero.
            Sptrunc = SPTRUNC;
            /// Difference, saturating.
            Ssub = SSUB;
            /// Difference, wrapping.
            Sub = SUB;
            /// One step of a division.
            Subc = SUBC;
            /// Difference of singles.
            Subsp = SUBSP;
            /// Difference of doubles.
            Subdp = SUBDP;
            /// Unsigned difference into 40 bits.
            Subu = SUBU;
            /// Bits set in one of both.
            Xor = XOR;
            /// Signed low · signed low.
            Mpy = MPY;
            /// Unsigned low · unsigned low.
            Mpyu = MPYU;
            /// Unsigned low · signed low.
            Mpyus = MPYUS;
            /// Signed low · unsigned low.
            Mpysu = MPYSU;
            /// Signed high · signed high.
            Mpyh = MPYH;
            /// Unsigned high · unsigned high.
            Mpyhu = MPYHU;
            /// Unsigned high · signed high.
            Mpyhus = MPYHUS;
            /// Signed high · unsigned high.
            Mpyhsu = MPYHSU;
            /// Signed high · signed low.
            Mpyhl = MPYHL;
            /// Unsigned high · unsigned low.
            Mpyhlu = MPYHLU;
            /// Unsigned high · signed low.
            Mpyhuls = MPYHULS;
            /// Signed high · unsigned low.
            Mpyhslu = MPYHSLU;
            /// Signed low · signed high.
            Mpylh = MPYLH;
            /// Unsigned low · unsigned high.
            Mpylhu = MPYLHU;
            /// Unsigned low · signed high.
            Mpyluhs = MPYLUHS;
            /// Signed low · unsigned high.
            Mpylshu = MPYLSHU;
            /// Twice low · low, saturating.
            Smpy = SMPY;
            /// Twice high · high, saturating.
            Smpyh = SMPYH;
            /// Twice high · low, saturating.
            Smpyhl = SMPYHL;
            /// Twice low · high, saturating.
            Smpylh = SMPYLH;
            /// Product of singles.
            Mpysp = MPYSP;
            /// Product of doubles.
            Mpydp = MPYDP;
            /// Low 32 bits of a product.
            Mpyi = MPYI;
            /// 64 bits of a product.
            Mpyid = MPYID;
            /// Single · double.
            Mpyspdp = MPYSPDP;
            /// Single · single into a double.
            Mpysp2dp = MPYSP2DP;
            /// Address plus bytes.
            Addab = ADDAB;
            /// Address plus halfwords.
            Addah = ADDAH;
            /// Address plus words.
            Addaw = ADDAW;
            /// Address minus bytes.
            Subab = SUBAB;
            /// Address minus halfwords.
            Subah = SUBAH;
            /// Address minus words.
            Subaw = SUBAW;
            /// Address plus double words.
            Addad = ADDAD;
            /// Sums of halves.
            Add2 = ADD2;
            /// Differences of halves.
            Sub2 = SUB2;
            /// Clears a field of bits.
            Clr = CLR;
            /// Sets a field of bits.
            Set = SET;
            /// Takes a field of bits, signed.
            Ext = EXT;
            /// Takes a field of bits, unsigned.
            Extu = EXTU;
            /// Shift left.
            Shl = SHL;
            /// Shift right, signed.
            Shr = SHR;
            /// Shift right, unsigned.
            Shru = SHRU;
            /// Shift left, saturating.
            Sshl = SSHL;
            /// Absolute value of a single.
            Abssp = ABSSP;
            /// Absolute value of a double.
            Absdp = ABSDP;
            /// 1 if singles are equal.
            Cmpeqsp = CMPEQSP;
            /// 1 if doubles are equal.
            Cmpeqdp = CMPEQDP;
            /// 1 if a single is greater.
            Cmpgtsp = CMPGTSP;
            /// 1 if a double is greater.
            Cmpgtdp = CMPGTDP;
            /// 1 if a single is less.
            Cmpltsp = CMPLTSP;
            /// 1 if a double is less.
            Cmpltdp = CMPLTDP;
            /// Estimate of 1/x, single.
            Rcpsp = RCPSP;
            /// Estimate of 1/x, double.
            Rcpdp = RCPDP;
            /// Estimate of 1/√x, single.
            Rsqrsp = RSQRSP;
            /// Estimate of 1/√x, double.
            Rsqrdp = RSQRDP;
            /// Single to double.
            Spdp = SPDP;
            /// A constant of 16 bits, signed.
            Mvk = MVK;
            /// The upper half becomes a constant.
            Mvkh = MVKH;
            /// Adds a constant of 16 bits.
            Addk = ADDK;
            /// Branch, after five more cycles.
            B = B;
            /// To or from a control register.
            Mvc = MVC;
            /// Loads 16 bits, unsigned.
            Ldhu = LDHU moves 2;
            /// Loads 8 bits, unsigned.
            Ldbu = LDBU moves 1;
            /// Loads 8 bits, signed.
            Ldb = LDB moves 1;
            /// Stores 8 bits.
            Stb = STB moves 1;
            /// Loads 16 bits, signed.
            Ldh = LDH moves 2;
            /// Stores 16 bits.
            Sth = STH moves 2;
            /// Loads 32 bits.
            Ldw = LDW moves 4;
            /// Loads 64 bits into a pair.
            Lddw = LDDW moves 8;
            /// Stores 32 bits.
            Stw = STW moves 4;
            /// Passes cycles.
            Nop = NOP;
            /// Waits for an interrupt.
            Idle = IDLE;
        }
    };
}

macro_rules! define_mnemonics {
    ($($(#[doc = $doc:literal])* $name:ident = $text:ident $(moves $bytes:literal)?;)*) => {
        /// The name of an instruction.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Mnemonic {
            $($(#[doc = $doc])* $name,)*
        }

        impl Mnemonic {
            /// All mnemonics.
            pub const ALL: &'static [Self] = &[$(Self::$name),*];

            /// The name in capitals, as the assembler writes it.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$name => stringify!($text),)*
                }
            }

            /// A short description of its operation.
            #[must_use]
            pub const fn meaning(self) -> &'static str {
                match self {
                    $(Self::$name => concat!($($doc),*),)*
                }
            }

            /// The number of bytes moved by a load or store with this name; `None` for all others.
            #[must_use]
            pub const fn bytes(self) -> Option<u32> {
                match self {
                    $(Self::$name => define_mnemonics!(@bytes $($bytes)?),)*
                }
            }
        }
    };
    (@bytes) => { None };
    (@bytes $bytes:literal) => { Some($bytes) };
}
for_each_mnemonic!(define_mnemonics);

impl Mnemonic {
    /// The mnemonic with this name, in any case.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|mnemonic| mnemonic.name().eq_ignore_ascii_case(name))
    }
}

impl fmt::Display for Mnemonic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
