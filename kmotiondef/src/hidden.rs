//! Names that firmware 4.34 has beside the functions and variables that programs can use.
//!
//! The vendor's linker knows them all, so a program that defines a global of such a name does
//! not link there: `defined twice`. Nothing else is made of them.
//!
//! Source: table `api/reserved-names.csv` of the specification.

/// Reports whether the firmware has a symbol of this name that no table describes.
#[must_use]
pub fn is_hidden(name: &str) -> bool {
    HIDDEN_NAMES.binary_search(&name).is_ok()
}

/// The names, sorted.
#[rustfmt::skip]
pub const HIDDEN_NAMES: &[&str] = &[
    "ADC_BufferOut", "ADC_EDMA_Params", "ActualStepPos", "AuxBoard", "AuxBoardAddresses", "AuxBoardInputs",
    "AuxBoardOutputs", "AuxMinTime", "AuxReadData0", "AuxReadData0_Aux0", "AuxReadData1",
    "AuxReadData1_Aux0", "AuxReadData2", "AuxReadData2_Aux0", "AuxReadData3", "AuxReadData3_Aux0",
    "AuxReadData4", "AuxReadData4_Aux0", "AuxReadDataClk0", "AuxReadDataClk0_Aux0", "AuxReadDataClk1",
    "AuxReadDataClk1_Aux0", "AuxReadDataClk2", "AuxReadDataClk2_Aux0", "AuxReadDataClk3",
    "AuxReadDataClk3_Aux0", "AuxSelectBoardSendData0", "AuxSelectBoardSendData0_Aux0",
    "AuxSelectBoardSendData1", "AuxSelectBoardSendData1_Aux0", "AuxSendData1", "AuxSendData1_Aux0",
    "AuxWordIn", "BoardSerial", "BootLoader", "BootVersion", "Bootstackb", "Bootstacke", "BuildHash",
    "BuildSineTable", "C$$EXIT", "CS0_StoppingBeingProcessed", "CalcVelocityChange", "Commands",
    "ConfigGPIOPins", "Config_ADC_EDMA", "Config_DAC_EDMA", "ConfigureFPGAKernel", "ConfigureFPGA_AMP",
    "ConfigureFPGA_Boot", "ConfigureFPGA_BootR", "ConfigureFPGA_Kanalog", "CreateSpline", 
    "DAC_EDMA_Params", "DecelTimeForAxis", "Decode", "Decompress", "DecompressR", "Delay_boot",
    "Delay_loop", "DoADCInput", "DoAxis", "DoBacklash", "DoEndMotion", "DoGather", "DoKStep", "DoKanalog",
    "DoLimitSwitches", "DoPosition", "DoQuadratureInput", "DoRS232CmdsZigBee", "DoResolverInput",
    "DoServiceRS232", "DoSpecial", "DoSpindle", "DoSpline", "DoTime", "DoTrajectorys", "DoTrip",
    "DoingEndMotion", "DummyRTS", "EDMA_allocTable", "EDMA_clearChannel", "EDMA_configArgs",
    "EDMA_disableChannel", "EDMA_enableChannel", "EDMA_getTableAddress", "EDMA_link", "EDMA_open",
    "EDMA_reset", "EnableRS232CmdsZigBee", "ExpectedTime", "FPGA0", "FPGA0_BOOT", "FPGA1", "FPGA1_BOOT",
    "FPGA_AMP0", "FPGA_AMP1", "FatalError", "FillRandom", "FindNextActiveThread", "FinishSnapReads",
    "FirstTime_Aux0", "FirstTime_Aux1", "FlashPassWord", "FloatParam", "GET", "GetA14", "GetCharTimeout",
    "GetFlashID", "GetHex", "HPisdp", "HandleEndMotion", "Hash", "HashTable", "Idle", "InitializeChannel",
    "InitializeChannelPowerUp", "InjectRandom", "IntParam", "InterpolateArcSegment",
    "InterpolateLinearSegment", "Jmp_c_int00", "Jump", "LastBank", "LastPage", "LastReadStatus",
    "LastServiceAuxTime", "LastThreadActive", "LinF", "LockFlash", "Logtable_asm", "MaxDecelTimeForAxis",
    "MemoryKanOutputs", "MemorySnap0BitsDiffIn", "MemorySnap0BitsIn", "MemorySnap1BitsDiffIn",
    "MemorySnap1BitsIn", "Microstep", "NCommands", "NextThreadList", "OneE2", "PC", "Pos",
    "PrepareSnapTable", "PrintLn", "PrintMutex", "PrintQueue", "PrintfMutex", "ProgramFlashMess",
    "PutFlash", "PutQuickErrorMessage", "QEAxisMsg", "Quadradic", "QuickErrorAxis", "QuickErrorMessage",
    "QuickErrs", "QuickTestSDRAM", "RS232_PutCharZigBee", "ReadAndClear", "ReadFileType",
    "ReadSnap16CheckEmpty", "ReadSnap8CheckEmpty", "ReadSnapAmp8bits", "ReadSnapAmpxx", "ReleaseAllMutexes",
    "RequestTaskStopImmediate", "RequestedTaskStopImmediate", "ResumeIndependentMotion", "RunNormal",
    "SP01", "SaveIRP", "SaveStack", "SendDigit", "SendHex", "ServiceAux", "ServicePrintQueue",
    "ServiceRS232", "ServiceRequestedTasks", "ServiceSnapRead", "Servo", "SetByteAux", "SetByte_Aux0",
    "SetCCLKBit_Boot", "SetCpuPLL", "SetCpuPLL_Boot", "SetD0Bit_Boot", "SetEMIF", "SetFlashBankBoot",
    "SetProgramBit_Boot", "SetSpecialBufCmd", "SetUpDMAandSerial2_Boot", "SetupEndMotion", "SetupForJog",
    "SetupIO_to_Configure_FPGA_Boot", "ShowError", "Sine100", "SineTable", "Skip", "SlowSnapCnt",
    "SlowTableSequence", "SnapTable", "SnapTableEncoders", "SnapTableEncodersValid", "Splinek", "Splines",
    "Stacks", "StartEDMA", "StartServoInterrupt", "StartTimer0", "StepAndDir", "StopConditions",
    "StopIndependentMotion", "StopServoInterrupt", "ThreadActive", "ToUpper", "USB_CTRL_SHADOW",
    "USB_GetChar", "USB_GetChar_Boot", "USB_GetChar_Boot_Fast", "USB_PutChar", "USB_PutChar_Boot", "Vel",
    "Write16", "Write32", "Write3PH_Snap", "Write8", "WriteFileType", "WriteSnapAmpNoDelay", "ZigBeeTxBuf",
    "ZigPos", "_cleanup_ptr", "_ctypes_", "_divli", "_divul", "_dtors_ptr", "_fixdli", "_fixfu", "_lock",
    "_main", "_memory_size", "_nop", "_printfi", "_register_lock", "_register_unlock", "_remli", "_remul",
    "_round", "_roundf", "_scanfi", "_stack", "_strasg", "_sys_memory", "_trunc", "_truncf", "_unlock",
    "atan2sp", "atansp", "auto_init", "bb", "c_int00", "c_int10", "c_int10_dummy", "cosdp", "cossp",
    "divdp", "divsp", "errno", "exp10dp", "exp10sp", "exp2dp", "exp2sp", "exp_ctable", "exp_ktable",
    "expdp", "expsp", "get_hex_int", "get_int", "hEdmaADCS", "hEdmaDACS", "hEdmaNULL", "i3PH", "i4PH",
    "iADC", "iArc", "iArcHex", "iArcHexEx", "iArcHexYZ", "iArcHexYZEx", "iArcHexZX", "iArcHexZXEx",
    "iArcYZ", "iArcZX", "iBegRapidBuf", "iCheckDone", "iCheckDoneBuf", "iCheckDoneGather",
    "iCheckDoneXYZABC", "iCheckThread", "iClearBit", "iClearBitBuf", "iClearFlashImage", "iConfigSpindle",
    "iDAC", "iDisableAxis", "iDownloadGatherHex", "iEcho", "iEnableAxis", "iEnableAxisDest", "iEndRapidBuf",
    "iEntryPoint", "iExecTime", "iExecute", "iFLASH", "iFPGA", "iFPGAW", "iFlushBuf",
    "iGatherMove", "iGatherStep", "iGetBitDirection", "iGetGatherDec", "iGetPersistDec", "iGetPersistHex",
    "iGetSpindleRPS", "iGetStopState", "iGetVirtualBits", "iIIR", "iInject", "iJog", "iKill", "iLED",
    "iLHex1", "iLHex2", "iLHexEx1", "iLimitSwitch", "iLinear", "iLinearEx", "iLinearHex", "iLinearHexEx",
    "iLoadData", "iLoadFlash", "iMove", "iMoveAtVel", "iMoveExp", "iMoveRel", "iMoveRelAtVel",
    "iMoveXYZABC", "iPWM", "iPWMC", "iPWMR", "iProgFlashImage", "iRS232", "iReadBit",
    "iReadDiskData", "iReboot", "iSetBit", "iSetBitBuf", "iSetBitDirection", "iSetFRO", "iSetFROTemp",
    "iSetFROwRate", "iSetFROwRateTemp", "iSetGatherDec", "iSetPersistDec", "iSetPersistHex", "iSetRapidFRO",
    "iSetRapidFROwRate", "iSetStartupThread", "iSetStateBit", "iSetStateBitBuf", "iStopImmediately",
    "iTrigThread", "iUSB", "iUploadGather", "iUploadGatherHex", "iUploadInject", "iUploadStatus",
    "iVersion", "iWaitBitBuf", "iWaitNotBitBuf", "iZero", "iir_filter_3rd_order", "ilen", "last_step",
    "last_time", "last_time_valid", "linebuf", "log10dp", "log10sp", "log2dp", "log2sp", "logdp", "logsp",
    "minit", "nAuxBoards", "n_linebufchars", "nmnL2", "pCurSnapRead", "pEndSnapRead", "print_int",
    "printlock", "printunlock", "readline", "readline2", "readline2_RS232", "readline2_RS232Zigbee", "s",
    "sendline", "sendline_error", "sindp", "sinsp", "sparam", "sqrtsp", "src",
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::table;

    #[test]
    fn hidden_names_are_the_other_reserved_names_of_the_specification() {
        let rows = table("reserved-names.csv").into_iter();
        let mut specified: Vec<_> = rows
            .filter(|row| row["in_functions_or_variables_table"] == "no")
            .map(|row| row["name"].clone())
            .collect();
        specified.sort();
        assert_eq!(HIDDEN_NAMES, specified);
    }
}
