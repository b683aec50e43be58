//! Rows of the .S units: shifts, bit fields, constants, compares of floating-point values, branches; and `NOP`, `IDLE`.

/// Appends these rows to the previous ones and continues with the next file; see [`crate::for_each_form!`].
#[doc(hidden)]
#[macro_export]
macro_rules! rows_of_s {
    ($m:ident $($before:tt)*) => {
        $crate::rows_of_m! { $m $($before)*
            /// `dst = s1 + s2 (single)`
            AddspSRXrR = Addsp.S.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0E18 of 0x0000_0FFC, Four, Plus;
            /// `dst = s1 - s2 (single)`
            SubspSRXrR = Subsp.S.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0E38 of 0x0000_0FFC, Four, Plus;
            /// `dst = s2 - s1` (single); disputed, see [`Op::is_disputed`]
            SubspSRXrRRev = Subsp.S.r_xr_r_rev { src1: R, src2: Xr, dst: R }, word 0x0000_0EB8 of 0x0000_0FFC, Four, Plus;
            /// `dst = s1 + s2 (double)`
            AdddpSDXdD = Adddp.S.d_xd_d { src1: D, src2: Xd, dst: D }, word 0x0000_0E58 of 0x0084_2FFC, DoubleSum, Plus;
            /// `dst = s1 - s2 (double)`
            SubdpSDXdD = Subdp.S.d_xd_d { src1: D, src2: Xd, dst: D }, word 0x0000_0E78 of 0x0084_2FFC, DoubleSum, Plus;
            /// `dst = s2 - s1` (double); disputed, see [`Op::is_disputed`]
            SubdpSDXdDRev = Subdp.S.d_xd_d_rev { src1: D, src2: Xd, dst: D }, word 0x0000_0EF8 of 0x0084_2FFC, DoubleSum, Plus;
            /// `dst = s1 + s2 mod 2^32`
            AddSRXrR = Add.S.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_01E0 of 0x0000_0FFC, Single, Base;
            /// `dst = s1 + s2 mod 2^32`
            AddSC5XrR = Add.S.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_01A0 of 0x0000_0FFC, Single, Base;
            /// `dst.lo16 = s1.lo16 + s2.lo16; dst.hi16 = s1.hi16 + s2.hi16; no carry between`
            Add2SRXrR = Add2.S.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0060 of 0x0000_0FFC, Single, Base;
            /// `dst.lo16 = s1.lo16 - s2.lo16; dst.hi16 = s1.hi16 - s2.hi16`
            Sub2SRXrR = Sub2.S.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0460 of 0x0000_0FFC, Single, Base;
            /// `dst = s1 & s2`
            AndSRXrR = And.S.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_07E0 of 0x0000_0FFC, Single, Base;
            /// `dst = sx(s1) & s2`
            AndSC5XrR = And.S.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_07A0 of 0x0000_0FFC, Single, Base;
            /// `dst = s1 | s2`
            OrSRXrR = Or.S.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_06E0 of 0x0000_0FFC, Single, Base;
            /// `dst = sx(s1) | s2`
            OrSC5XrR = Or.S.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_06A0 of 0x0000_0FFC, Single, Base;
            /// `dst = s1 ^ s2`
            XorSRXrR = Xor.S.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_02E0 of 0x0000_0FFC, Single, Base;
            /// `dst = sx(s1) ^ s2`
            XorSC5XrR = Xor.S.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_02A0 of 0x0000_0FFC, Single, Base;
            /// `dst = s1 - s2 mod 2^32`
            SubSRXrR = Sub.S.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_05E0 of 0x0000_0FFC, Single, Base;
            /// `dst = s1 - s2 mod 2^32`
            SubSC5XrR = Sub.S.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_05A0 of 0x0000_0FFC, Single, Base;
            /// `a = s1[9:5], b = s1[4:0]; dst = s2 with bits a..b cleared (b<a: unchanged)`
            ClrSRXrR = Clr.S.r_xr_r { src2: Xr, src1: R, dst: R }, word 0x0000_0FE0 of 0x0000_0FFC, Single, Base;
            /// `a = s1[9:5], b = s1[4:0]; dst = s2 with bits a..b set (b<a: unchanged)`
            SetSRXrR = Set.S.r_xr_r { src2: Xr, src1: R, dst: R }, word 0x0000_0EE0 of 0x0000_0FFC, Single, Base;
            /// `dst = (s2 << s1[9:5]) >> s1[4:0], arithmetic`
            ExtSRXrR = Ext.S.r_xr_r { src2: Xr, src1: R, dst: R }, word 0x0000_0BE0 of 0x0000_0FFC, Single, Base;
            /// `dst = (s2 << s1[9:5]) >> s1[4:0], logical`
            ExtuSRXrR = Extu.S.r_xr_r { src2: Xr, src1: R, dst: R }, word 0x0000_0AE0 of 0x0000_0FFC, Single, Base;
            /// `n = s1[5:0]; dst = n>31 ? 0 : s2 << n`
            ShlSRXrR = Shl.S.r_xr_r { src2: Xr, src1: R, dst: R }, word 0x0000_0CE0 of 0x0000_0FFC, Single, Base;
            /// `n = s1[5:0]; dst = n>31 ? 0 : s2 << n`
            ShlSU5XrR = Shl.S.u5_xr_r { src2: Xr, src1: U5, dst: R }, word 0x0000_0CA0 of 0x0000_0FFC, Single, Base;
            /// `n = s1[5:0]; dst = n>39 ? 0 : s2 << n mod 2^40`
            ShlSRLL = Shl.S.r_l_l { src2: L, src1: R, dst: L }, word 0x0000_0C60 of 0x0084_1FFC, Single, Base;
            /// `n = s1[5:0]; dst = n>39 ? 0 : s2 << n mod 2^40`
            ShlSU5LL = Shl.S.u5_l_l { src2: L, src1: U5, dst: L }, word 0x0000_0C20 of 0x0084_1FFC, Single, Base;
            /// `n = s1[5:0]; dst = n>39 ? 0 : zx(s2) << n mod 2^40`
            ShlSRXrL = Shl.S.r_xr_l { src2: Xr, src1: R, dst: L }, word 0x0000_04E0 of 0x0080_0FFC, Single, Base;
            /// `n = s1[5:0]; dst = n>39 ? 0 : zx(s2) << n mod 2^40`
            ShlSU5XrL = Shl.S.u5_xr_l { src2: Xr, src1: U5, dst: L }, word 0x0000_04A0 of 0x0080_0FFC, Single, Base;
            /// `n = min(s1[5:0],31); dst = signed s2 >> n`
            ShrSRXrR = Shr.S.r_xr_r { src2: Xr, src1: R, dst: R }, word 0x0000_0DE0 of 0x0000_0FFC, Single, Base;
            /// `n = min(s1[5:0],31); dst = signed s2 >> n`
            ShrSU5XrR = Shr.S.u5_xr_r { src2: Xr, src1: U5, dst: R }, word 0x0000_0DA0 of 0x0000_0FFC, Single, Base;
            /// `n = min(s1[5:0],39); dst = signed 40-bit s2 >> n`
            ShrSRLL = Shr.S.r_l_l { src2: L, src1: R, dst: L }, word 0x0000_0D60 of 0x0084_1FFC, Single, Base;
            /// `n = min(s1[5:0],39); dst = signed 40-bit s2 >> n`
            ShrSU5LL = Shr.S.u5_l_l { src2: L, src1: U5, dst: L }, word 0x0000_0D20 of 0x0084_1FFC, Single, Base;
            /// `n = s1[5:0]; dst = n>31 ? 0 : unsigned s2 >> n`
            ShruSRXrR = Shru.S.r_xr_r { src2: Xr, src1: R, dst: R }, word 0x0000_09E0 of 0x0000_0FFC, Single, Base;
            /// `n = s1[5:0]; dst = n>31 ? 0 : unsigned s2 >> n`
            ShruSU5XrR = Shru.S.u5_xr_r { src2: Xr, src1: U5, dst: R }, word 0x0000_09A0 of 0x0000_0FFC, Single, Base;
            /// `n = s1[5:0]; dst = n>39 ? 0 : unsigned 40-bit s2 >> n`
            ShruSRLL = Shru.S.r_l_l { src2: L, src1: R, dst: L }, word 0x0000_0960 of 0x0084_1FFC, Single, Base;
            /// `n = s1[5:0]; dst = n>39 ? 0 : unsigned 40-bit s2 >> n`
            ShruSU5LL = Shru.S.u5_l_l { src2: L, src1: U5, dst: L }, word 0x0000_0920 of 0x0084_1FFC, Single, Base;
            /// `dst = sat32(signed s2 << s1[4:0])`
            SshlSRXrR = Sshl.S.r_xr_r { src2: Xr, src1: R, dst: R }, word 0x0000_08E0 of 0x0000_0FFC, Single, Base;
            /// `dst = sat32(signed s2 << s1[4:0])`
            SshlSU5XrR = Sshl.S.u5_xr_r { src2: Xr, src1: U5, dst: R }, word 0x0000_08A0 of 0x0000_0FFC, Single, Base;
            /// `dst = s2 & 0x7FFFFFFF`
            AbsspSXrR = Abssp.S.xr_r { src2: Xr, dst: R }, word 0x0000_0F20 of 0x0003_EFFC, Single, Base;
            /// `dst = s2 with the sign bit cleared`
            AbsdpSDD = Absdp.S.d_d { src2: Dodd, dst: D }, word 0x0004_0B20 of 0x0084_3FFC, DoubleMove, Base;
            /// `dst = (s1 == s2) ? 1 : 0 (single; NaN: 0)`
            CmpeqspSRXrR = Cmpeqsp.S.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0E20 of 0x0000_0FFC, Single, Base;
            /// `dst = (s1 == s2) ? 1 : 0 (double; NaN: 0)`
            CmpeqdpSDXdR = Cmpeqdp.S.d_xd_r { src1: D, src2: Xd, dst: R }, word 0x0000_0A20 of 0x0004_2FFC, DoubleCompare, Base;
            /// `dst = (s1 > s2) ? 1 : 0 (single; NaN: 0)`
            CmpgtspSRXrR = Cmpgtsp.S.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0E60 of 0x0000_0FFC, Single, Base;
            /// `dst = (s1 > s2) ? 1 : 0 (double; NaN: 0)`
            CmpgtdpSDXdR = Cmpgtdp.S.d_xd_r { src1: D, src2: Xd, dst: R }, word 0x0000_0A60 of 0x0004_2FFC, DoubleCompare, Base;
            /// `dst = (s1 < s2) ? 1 : 0 (single; NaN: 0)`
            CmpltspSRXrR = Cmpltsp.S.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0EA0 of 0x0000_0FFC, Single, Base;
            /// `dst = (s1 < s2) ? 1 : 0 (double; NaN: 0)`
            CmpltdpSDXdR = Cmpltdp.S.d_xd_r { src1: D, src2: Xd, dst: R }, word 0x0000_0AA0 of 0x0004_2FFC, DoubleCompare, Base;
            /// `dst = estimate of 1/s2, 8 bits`
            RcpspSXrR = Rcpsp.S.xr_r { src2: Xr, dst: R }, word 0x0000_0F60 of 0x0003_EFFC, Single, Base;
            /// `dst = estimate of 1/s2, 8 bits`
            RcpdpSDD = Rcpdp.S.d_d { src2: Dodd, dst: D }, word 0x0004_0B60 of 0x0084_3FFC, DoubleMove, Base;
            /// `dst = estimate of 1/sqrt(s2), 8 bits`
            RsqrspSXrR = Rsqrsp.S.xr_r { src2: Xr, dst: R }, word 0x0000_0FA0 of 0x0003_EFFC, Single, Base;
            /// `dst = estimate of 1/sqrt(s2), 8 bits`
            RsqrdpSDD = Rsqrdp.S.d_d { src2: Dodd, dst: D }, word 0x0004_0BA0 of 0x0084_3FFC, DoubleMove, Base;
            /// `dst = double(single s2)`
            SpdpSXrD = Spdp.S.xr_d { src2: Xr, dst: D }, word 0x0000_00A0 of 0x0083_EFFC, DoubleMove, Base;
            /// `dst = (s2 << csta) >> cstb, logical`
            ExtuSRU5U5R = Extu.S.r_u5_u5_r { src2: R, csta: U5, cstb: U5, dst: R }, word 0x0000_0008 of 0x0000_00FC, Single, Base;
            /// `dst = (s2 << csta) >> cstb, arithmetic`
            ExtSRU5U5R = Ext.S.r_u5_u5_r { src2: R, csta: U5, cstb: U5, dst: R }, word 0x0000_0048 of 0x0000_00FC, Single, Base;
            /// `dst = s2 with bits csta..cstb set (cstb<csta: unchanged)`
            SetSRU5U5R = Set.S.r_u5_u5_r { src2: R, csta: U5, cstb: U5, dst: R }, word 0x0000_0088 of 0x0000_00FC, Single, Base;
            /// `dst = s2 with bits csta..cstb cleared (cstb<csta: unchanged)`
            ClrSRU5U5R = Clr.S.r_u5_u5_r { src2: R, csta: U5, cstb: U5, dst: R }, word 0x0000_00C8 of 0x0000_00FC, Single, Base;
            /// `dst = sx(cst)`
            Mvk = Mvk.S.c16_r { cst: C16, dst: R }, word 0x0000_0028 of 0x0000_007C, Single, Base;
            /// `dst = (cst << 16) | (dst & 0xFFFF)`
            Mvkh = Mvkh.S.u16_r { cst: H16, dst: R }, word 0x0000_0068 of 0x0000_007C, Single, Base;
            /// `dst = dst + sx(cst)`
            Addk = Addk.S.c16_r { cst: C16, dst: R }, word 0x0000_0050 of 0x0000_007C, Single, Base;
            /// `target = (address of this word & ~31) + 4*sx(cst)`
            BDisp = B.S.disp21 { cst: Disp }, word 0x0000_0010 of 0x0000_007C, Branch, Base;
            /// `target = src2`
            BReg = B.S.xr { src2: Xr }, word 0x0000_0362 of 0x0F83_EFFE, Branch, Base;
            /// `target = IRP; GIE = PGIE (E1)`
            BIrp = B.S.irp { src2: Irp }, word 0x0018_00E2 of 0x0FFF_FFFE, Branch, Base;
            /// `target = NRP; NMIE = 1`
            BNrp = B.S.nrp { src2: Nrp }, word 0x001C_00E2 of 0x0FFF_FFFE, Branch, Base;
            /// `dst = control register`
            MvcRead = Mvc.S.cr_r { src2: Cr, dst: R2 }, word 0x0000_03E2 of 0x0003_FFFE, Single, Base;
            /// `control register = src2`
            MvcWrite = Mvc.S.xr_cr { src2: Xr, dst: Crw }, word 0x0000_03A2 of 0x0003_EFFE, Single, Base;
            /// `n + 1` cycles pass (field 0..8); ends early when the target of a branch starts.
            Nop = Nop.N.n { n: Count }, word 0x0000_0000 of 0xFFFE_1FFE, Nothing, Base;
            /// Waits for an interrupt.
            Idle = Idle.N.none {}, word 0x0001_E000 of 0xFFFF_FFFE, Nothing, Base;
        }
    };
}
