//! Rows of the .L units: sums, compares, logic, conversions.

/// Appends these rows to the previous ones and continues with the next file; see [`crate::for_each_form!`].
#[doc(hidden)]
#[macro_export]
macro_rules! rows_of_l {
    ($m:ident $($before:tt)*) => {
        $crate::rows_of_s! { $m $($before)*
            /// `dst = s2<0 ? sat32(-s2) : s2  (0x80000000 -> 0x7FFFFFFF)`
            AbsLXrR = Abs.L.xr_r { src2: Xr, dst: R }, word 0x0000_0358 of 0x0003_EFFC, Single, Base;
            /// `dst = s2<0 ? -s2 : s2 (40 bit; -2^39: stays 0x80_0000_0000)`
            AbsLLL = Abs.L.l_l { src2: L, dst: L }, word 0x0000_0718 of 0x0087_FFFC, Single, Base;
            /// `dst = s1 + s2 mod 2^32`
            AddLRXrR = Add.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0078 of 0x0000_0FFC, Single, Base;
            /// `dst = s1 + s2 mod 2^32`
            AddLC5XrR = Add.L.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_0058 of 0x0000_0FFC, Single, Base;
            /// `dst = sx(s1) + sx(s2) mod 2^40`
            AddLRXrL = Add.L.r_xr_l { src1: R, src2: Xr, dst: L }, word 0x0000_0478 of 0x0080_0FFC, Single, Base;
            /// `dst = sx(s1) + sx(s2) mod 2^40`
            AddLXrLL = Add.L.xr_l_l { src1: Xr, src2: L, dst: L }, word 0x0000_0438 of 0x0084_0FFC, Single, Base;
            /// `dst = sx(s1) + sx(s2) mod 2^40`
            AddLC5LL = Add.L.c5_l_l { src1: C5, src2: L, dst: L }, word 0x0000_0418 of 0x0084_1FFC, Single, Base;
            /// `dst = zx(s1) + zx(s2) (33 bits in 40)`
            AdduLRXrL = Addu.L.r_xr_l { src1: R, src2: Xr, dst: L }, word 0x0000_0578 of 0x0080_0FFC, Single, Base;
            /// `dst = zx(s1) + s2 mod 2^40`
            AdduLXrLL = Addu.L.xr_l_l { src1: Xr, src2: L, dst: L }, word 0x0000_0538 of 0x0084_0FFC, Single, Base;
            /// `dst = s1 + s2 (single)`
            AddspLRXrR = Addsp.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0218 of 0x0000_0FFC, Four, Base;
            /// `dst = s1 + s2 (double)`
            AdddpLDXdD = Adddp.L.d_xd_d { src1: D, src2: Xd, dst: D }, word 0x0000_0318 of 0x0084_2FFC, DoubleSum, Base;
            /// `dst = s1 & s2`
            AndLRXrR = And.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0F78 of 0x0000_0FFC, Single, Base;
            /// `dst = sx(s1) & s2`
            AndLC5XrR = And.L.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_0F58 of 0x0000_0FFC, Single, Base;
            /// `dst = (s1 == s2) ? 1 : 0, signed 32 bit`
            CmpeqLRXrR = Cmpeq.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0A78 of 0x0000_0FFC, Single, Base;
            /// `dst = (s1 == s2) ? 1 : 0, signed 32 bit`
            CmpeqLC5XrR = Cmpeq.L.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_0A58 of 0x0000_0FFC, Single, Base;
            /// `dst = (sx(s1) == s2) ? 1 : 0, signed 40 bit`
            CmpeqLXrLR = Cmpeq.L.xr_l_r { src1: Xr, src2: L, dst: R }, word 0x0000_0A38 of 0x0004_0FFC, Single, Base;
            /// `dst = (s1 == s2) ? 1 : 0, signed 40 bit`
            CmpeqLC5LR = Cmpeq.L.c5_l_r { src1: C5, src2: L, dst: R }, word 0x0000_0A18 of 0x0004_1FFC, Single, Base;
            /// `dst = (s1 > s2) ? 1 : 0, signed 32 bit`
            CmpgtLRXrR = Cmpgt.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_08F8 of 0x0000_0FFC, Single, Base;
            /// `dst = (s1 > s2) ? 1 : 0, signed 32 bit`
            CmpgtLC5XrR = Cmpgt.L.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_08D8 of 0x0000_0FFC, Single, Base;
            /// `dst = (sx(s1) > s2) ? 1 : 0, signed 40 bit`
            CmpgtLXrLR = Cmpgt.L.xr_l_r { src1: Xr, src2: L, dst: R }, word 0x0000_08B8 of 0x0004_0FFC, Single, Base;
            /// `dst = (s1 > s2) ? 1 : 0, signed 40 bit`
            CmpgtLC5LR = Cmpgt.L.c5_l_r { src1: C5, src2: L, dst: R }, word 0x0000_0898 of 0x0004_1FFC, Single, Base;
            /// `dst = (s1 > s2) ? 1 : 0, unsigned 32 bit`
            CmpgtuLRXrR = Cmpgtu.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_09F8 of 0x0000_0FFC, Single, Base;
            /// `dst = (s1 > s2) ? 1 : 0, unsigned 32 bit`
            CmpgtuLU4XrR = Cmpgtu.L.u4_xr_r { src1: U4, src2: Xr, dst: R }, word 0x0000_09D8 of 0x0002_0FFC, Single, Base;
            /// `dst = (zx(s1) > s2) ? 1 : 0, unsigned 40 bit`
            CmpgtuLXrLR = Cmpgtu.L.xr_l_r { src1: Xr, src2: L, dst: R }, word 0x0000_09B8 of 0x0004_0FFC, Single, Base;
            /// `dst = (s1 > s2) ? 1 : 0, unsigned 40 bit`
            CmpgtuLU4LR = Cmpgtu.L.u4_l_r { src1: U4, src2: L, dst: R }, word 0x0000_0998 of 0x0006_1FFC, Single, Base;
            /// `dst = (s1 < s2) ? 1 : 0, signed 32 bit`
            CmpltLRXrR = Cmplt.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0AF8 of 0x0000_0FFC, Single, Base;
            /// `dst = (s1 < s2) ? 1 : 0, signed 32 bit`
            CmpltLC5XrR = Cmplt.L.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_0AD8 of 0x0000_0FFC, Single, Base;
            /// `dst = (sx(s1) < s2) ? 1 : 0, signed 40 bit`
            CmpltLXrLR = Cmplt.L.xr_l_r { src1: Xr, src2: L, dst: R }, word 0x0000_0AB8 of 0x0004_0FFC, Single, Base;
            /// `dst = (s1 < s2) ? 1 : 0, signed 40 bit`
            CmpltLC5LR = Cmplt.L.c5_l_r { src1: C5, src2: L, dst: R }, word 0x0000_0A98 of 0x0004_1FFC, Single, Base;
            /// `dst = (s1 < s2) ? 1 : 0, unsigned 32 bit`
            CmpltuLRXrR = Cmpltu.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0BF8 of 0x0000_0FFC, Single, Base;
            /// `dst = (s1 < s2) ? 1 : 0, unsigned 32 bit`
            CmpltuLU4XrR = Cmpltu.L.u4_xr_r { src1: U4, src2: Xr, dst: R }, word 0x0000_0BD8 of 0x0002_0FFC, Single, Base;
            /// `dst = (zx(s1) < s2) ? 1 : 0, unsigned 40 bit`
            CmpltuLXrLR = Cmpltu.L.xr_l_r { src1: Xr, src2: L, dst: R }, word 0x0000_0BB8 of 0x0004_0FFC, Single, Base;
            /// `dst = (s1 < s2) ? 1 : 0, unsigned 40 bit`
            CmpltuLU4LR = Cmpltu.L.u4_l_r { src1: U4, src2: L, dst: R }, word 0x0000_0B98 of 0x0006_1FFC, Single, Base;
            /// `dst = round_to_int32(s2), saturating (nearest even)`
            DpintLDR = Dpint.L.d_r { src2: Dodd, dst: R }, word 0x0004_0118 of 0x0004_3FFC, Four, Base;
            /// `dst = single(s2)`
            DpspLDR = Dpsp.L.d_r { src2: Dodd, dst: R }, word 0x0004_0138 of 0x0004_3FFC, Four, Base;
            /// `dst = trunc_to_int32(s2), saturating`
            DptruncLDR = Dptrunc.L.d_r { src2: Dodd, dst: R }, word 0x0004_0038 of 0x0004_3FFC, Four, Base;
            /// `dst = double(signed s2)`
            IntdpLXrD = Intdp.L.xr_d { src2: Xr, dst: D }, word 0x0000_0738 of 0x0083_EFFC, Widening, Base;
            /// `dst = double(unsigned s2)`
            IntdpuLXrD = Intdpu.L.xr_d { src2: Xr, dst: D }, word 0x0000_0778 of 0x0083_EFFC, Widening, Base;
            /// `dst = single(signed s2)`
            IntspLXrR = Intsp.L.xr_r { src2: Xr, dst: R }, word 0x0000_0958 of 0x0003_EFFC, Four, Base;
            /// `dst = single(unsigned s2)`
            IntspuLXrR = Intspu.L.xr_r { src2: Xr, dst: R }, word 0x0000_0938 of 0x0003_EFFC, Four, Base;
            /// `dst = number of bits above the leftmost bit of s2 that equals s1&1; 32 if none`
            LmbdLRXrR = Lmbd.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0D78 of 0x0000_0FFC, Single, Base;
            /// `dst = number of bits above the leftmost bit of s2 that equals s1&1; 32 if none`
            LmbdLC5XrR = Lmbd.L.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_0D58 of 0x0000_0FFC, Single, Base;
            /// `dst = number of redundant sign bits of s2 (0..31)`
            NormLXrR = Norm.L.xr_r { src2: Xr, dst: R }, word 0x0000_0C78 of 0x0003_EFFC, Single, Base;
            /// `dst = number of redundant sign bits of the 40-bit s2 (0..39)`
            NormLLR = Norm.L.l_r { src2: L, dst: R }, word 0x0000_0C18 of 0x0007_FFFC, Single, Base;
            /// `dst = s1 | s2`
            OrLRXrR = Or.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0FF8 of 0x0000_0FFC, Single, Base;
            /// `dst = sx(s1) | s2`
            OrLC5XrR = Or.L.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_0FD8 of 0x0000_0FFC, Single, Base;
            /// `dst = sat32(s1 + s2)`
            SaddLRXrR = Sadd.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0278 of 0x0000_0FFC, Single, Base;
            /// `dst = sat32(s1 + s2)`
            SaddLC5XrR = Sadd.L.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_0258 of 0x0000_0FFC, Single, Base;
            /// `dst = sat40(sx(s1) + s2)`
            SaddLXrLL = Sadd.L.xr_l_l { src1: Xr, src2: L, dst: L }, word 0x0000_0638 of 0x0084_0FFC, Single, Base;
            /// `dst = sat40(s1 + s2)`
            SaddLC5LL = Sadd.L.c5_l_l { src1: C5, src2: L, dst: L }, word 0x0000_0618 of 0x0084_1FFC, Single, Base;
            /// `dst = sat32(40-bit s2)`
            SatLLR = Sat.L.l_r { src2: L, dst: R }, word 0x0000_0818 of 0x0007_FFFC, Single, Base;
            /// `dst = round_to_int32(single s2), saturating`
            SpintLXrR = Spint.L.xr_r { src2: Xr, dst: R }, word 0x0000_0158 of 0x0003_EFFC, Four, Base;
            /// `dst = trunc_to_int32(single s2), saturating`
            SptruncLXrR = Sptrunc.L.xr_r { src2: Xr, dst: R }, word 0x0000_0178 of 0x0003_EFFC, Four, Base;
            /// `dst = sat32(s1 - s2)`
            SsubLRXrR = Ssub.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_01F8 of 0x0000_0FFC, Single, Base;
            /// `dst = sat32(s1 - s2)`
            SsubLXrRR = Ssub.L.xr_r_r { src1: Xr, src2: R, dst: R }, word 0x0000_03F8 of 0x0000_0FFC, Single, Base;
            /// `dst = sat32(s1 - s2)`
            SsubLC5XrR = Ssub.L.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_01D8 of 0x0000_0FFC, Single, Base;
            /// `dst = sat40(s1 - s2)`
            SsubLC5LL = Ssub.L.c5_l_l { src1: C5, src2: L, dst: L }, word 0x0000_0598 of 0x0084_1FFC, Single, Base;
            /// `dst = s1 - s2 mod 2^32`
            SubLRXrR = Sub.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_00F8 of 0x0000_0FFC, Single, Base;
            /// `dst = s1 - s2 mod 2^32`
            SubLXrRR = Sub.L.xr_r_r { src1: Xr, src2: R, dst: R }, word 0x0000_02F8 of 0x0000_0FFC, Single, Base;
            /// `dst = s1 - s2 mod 2^32`
            SubLC5XrR = Sub.L.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_00D8 of 0x0000_0FFC, Single, Base;
            /// `dst = sx(s1) - sx(s2), 40 bit`
            SubLRXrL = Sub.L.r_xr_l { src1: R, src2: Xr, dst: L }, word 0x0000_04F8 of 0x0080_0FFC, Single, Base;
            /// `dst = sx(s1) - sx(s2), 40 bit`
            SubLXrRL = Sub.L.xr_r_l { src1: Xr, src2: R, dst: L }, word 0x0000_06F8 of 0x0080_0FFC, Single, Base;
            /// `dst = s1 - s2 mod 2^40`
            SubLC5LL = Sub.L.c5_l_l { src1: C5, src2: L, dst: L }, word 0x0000_0498 of 0x0084_1FFC, Single, Base;
            /// `dst = s1>=s2 (unsigned) ? ((s1-s2)<<1)+1 : s1<<1`
            SubcLRXrR = Subc.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0978 of 0x0000_0FFC, Single, Base;
            /// `dst = s1 - s2 (single)`
            SubspLRXrR = Subsp.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0238 of 0x0000_0FFC, Four, Base;
            /// `dst = s1 - s2 (single)`
            SubspLXrRR = Subsp.L.xr_r_r { src1: Xr, src2: R, dst: R }, word 0x0000_02B8 of 0x0000_0FFC, Four, Base;
            /// `dst = s1 - s2 (double)`
            SubdpLDXdD = Subdp.L.d_xd_d { src1: D, src2: Xd, dst: D }, word 0x0000_0338 of 0x0084_2FFC, DoubleSum, Base;
            /// `dst = s1 - s2 (double)`
            SubdpLXdDD = Subdp.L.xd_d_d { src1: Xd, src2: D, dst: D }, word 0x0000_03B8 of 0x0084_2FFC, DoubleSum, Base;
            /// `dst = zx(s1) - zx(s2) mod 2^40`
            SubuLRXrL = Subu.L.r_xr_l { src1: R, src2: Xr, dst: L }, word 0x0000_05F8 of 0x0080_0FFC, Single, Base;
            /// `dst = zx(s1) - zx(s2) mod 2^40`
            SubuLXrRL = Subu.L.xr_r_l { src1: Xr, src2: R, dst: L }, word 0x0000_07F8 of 0x0080_0FFC, Single, Base;
            /// `dst = s1 ^ s2`
            XorLRXrR = Xor.L.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0DF8 of 0x0000_0FFC, Single, Base;
            /// `dst = sx(s1) ^ s2`
            XorLC5XrR = Xor.L.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_0DD8 of 0x0000_0FFC, Single, Base;
        }
    };
}
