//! Rows of the .M units: products.

/// Appends these rows to the previous ones and continues with the next file; see [`crate::for_each_form!`].
#[doc(hidden)]
#[macro_export]
macro_rules! rows_of_m {
    ($m:ident $($before:tt)*) => {
        $crate::rows_of_d! { $m $($before)*
            /// `dst = s16lo(s1) * s16lo(s2)`
            MpyMRXrR = Mpy.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0C80 of 0x0000_0FFC, Product, Base;
            /// `dst = u16lo(s1) * u16lo(s2)`
            MpyuMRXrR = Mpyu.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0F80 of 0x0000_0FFC, Product, Base;
            /// `dst = u16lo(s1) * s16lo(s2)`
            MpyusMRXrR = Mpyus.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0E80 of 0x0000_0FFC, Product, Base;
            /// `dst = s16lo(s1) * u16lo(s2)`
            MpysuMRXrR = Mpysu.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0D80 of 0x0000_0FFC, Product, Base;
            /// `dst = s16hi(s1) * s16hi(s2)`
            MpyhMRXrR = Mpyh.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0080 of 0x0000_0FFC, Product, Base;
            /// `dst = u16hi(s1) * u16hi(s2)`
            MpyhuMRXrR = Mpyhu.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0380 of 0x0000_0FFC, Product, Base;
            /// `dst = u16hi(s1) * s16hi(s2)`
            MpyhusMRXrR = Mpyhus.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0280 of 0x0000_0FFC, Product, Base;
            /// `dst = s16hi(s1) * u16hi(s2)`
            MpyhsuMRXrR = Mpyhsu.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0180 of 0x0000_0FFC, Product, Base;
            /// `dst = s16hi(s1) * s16lo(s2)`
            MpyhlMRXrR = Mpyhl.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0480 of 0x0000_0FFC, Product, Base;
            /// `dst = u16hi(s1) * u16lo(s2)`
            MpyhluMRXrR = Mpyhlu.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0780 of 0x0000_0FFC, Product, Base;
            /// `dst = u16hi(s1) * s16lo(s2)`
            MpyhulsMRXrR = Mpyhuls.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0680 of 0x0000_0FFC, Product, Base;
            /// `dst = s16hi(s1) * u16lo(s2)`
            MpyhsluMRXrR = Mpyhslu.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0580 of 0x0000_0FFC, Product, Base;
            /// `dst = s16lo(s1) * s16hi(s2)`
            MpylhMRXrR = Mpylh.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0880 of 0x0000_0FFC, Product, Base;
            /// `dst = u16lo(s1) * u16hi(s2)`
            MpylhuMRXrR = Mpylhu.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0B80 of 0x0000_0FFC, Product, Base;
            /// `dst = u16lo(s1) * s16hi(s2)`
            MpyluhsMRXrR = Mpyluhs.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0A80 of 0x0000_0FFC, Product, Base;
            /// `dst = s16lo(s1) * u16hi(s2)`
            MpylshuMRXrR = Mpylshu.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0980 of 0x0000_0FFC, Product, Base;
            /// `dst = s1 * s16lo(s2)`
            MpyMC5XrR = Mpy.M.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_0C00 of 0x0000_0FFC, Product, Base;
            /// `dst = s1 * u16lo(s2)`
            MpysuMC5XrR = Mpysu.M.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_0F00 of 0x0000_0FFC, Product, Base;
            /// `dst = sat32((s16lo(s1) * s16lo(s2)) << 1)`
            SmpyMRXrR = Smpy.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0D00 of 0x0000_0FFC, Product, Base;
            /// `dst = sat32((s16hi(s1) * s16hi(s2)) << 1)`
            SmpyhMRXrR = Smpyh.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0100 of 0x0000_0FFC, Product, Base;
            /// `dst = sat32((s16hi(s1) * s16lo(s2)) << 1)`
            SmpyhlMRXrR = Smpyhl.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0500 of 0x0000_0FFC, Product, Base;
            /// `dst = sat32((s16lo(s1) * s16hi(s2)) << 1)`
            SmpylhMRXrR = Smpylh.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0900 of 0x0000_0FFC, Product, Base;
            /// `dst = s1 * s2 (single)`
            MpyspMRXrR = Mpysp.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0E00 of 0x0000_0FFC, Four, Base;
            /// `dst = s1 * s2 (double)`
            MpydpMDXdD = Mpydp.M.d_xd_d { src1: D, src2: Xd, dst: D }, word 0x0000_0700 of 0x0084_2FFC, DoubleProduct, Base;
            /// `dst = low32(s1 * s2)`
            MpyiMRXrR = Mpyi.M.r_xr_r { src1: R, src2: Xr, dst: R }, word 0x0000_0200 of 0x0000_0FFC, LongProduct, Base;
            /// `dst = low32(s1 * s2)`
            MpyiMC5XrR = Mpyi.M.c5_xr_r { src1: C5, src2: Xr, dst: R }, word 0x0000_0300 of 0x0000_0FFC, LongProduct, Base;
            /// `dst = signed 64-bit s1 * s2`
            MpyidMRXrD = Mpyid.M.r_xr_d { src1: R, src2: Xr, dst: D }, word 0x0000_0400 of 0x0080_0FFC, WideProduct, Base;
            /// `dst = signed 64-bit s1 * s2`
            MpyidMC5XrD = Mpyid.M.c5_xr_d { src1: C5, src2: Xr, dst: D }, word 0x0000_0600 of 0x0080_0FFC, WideProduct, Base;
            /// `dst = double(single s1) * double s2`
            MpyspdpMRXdD = Mpyspdp.M.r_xd_d { src1: R, src2: Xd, dst: D }, word 0x0000_05B0 of 0x0084_0FFC, MixedProduct, Plus;
            /// `dst = double(s1) * double(s2), exact`
            Mpysp2dpMRXrD = Mpysp2dp.M.r_xr_d { src1: R, src2: Xr, dst: D }, word 0x0000_05F0 of 0x0080_0FFC, SingleProduct, Plus;
        }
    };
}
